"""Legends that hide no data: data first and theory last, in rows as one reads."""

from collections.abc import Iterable, Mapping
from typing import Any

MOST = 8  # columns
WIDER = 1.1  # than axes are before margins are taken away, what a legend above may be


def entries(panels: Iterable[Any]) -> dict[str, Any]:
    """The handles of panels by their labels, each label once: points, other data, theory."""
    found: dict[str, Any] = {}
    for ax in panels:
        for handle, label in zip(*ax.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    # Matplotlib lists lines before points with error bars, which are tuples
    order = sorted(found, key=lambda name: ("theory" in name, not isinstance(found[name], tuple)))
    return {label: found[label] for label in order}


def along_rows(found: Mapping[str, Any], columns: int) -> dict[str, Any]:
    """Entries in the order in which Matplotlib, which fills columns first, shows them in rows.

    >>> list(along_rows(dict.fromkeys("abcde"), 3))
    ['a', 'd', 'b', 'e', 'c']
    """
    labels = list(found)
    return {label: found[label] for k in range(columns) for label in labels[k::columns]}


def legend_in_rows(
    place: Any, found: Mapping[str, Any], width: float, most: int = MOST, **look: Any
) -> None:
    """A legend of axes or of a figure in as few rows as are no wider than `width` pixels.

    Rows have the same number of entries, but for the last; `look` is of Matplotlib's legends.
    """
    count = len(found)
    for rows in range(1, count + 1):
        columns = -(-count // rows)
        if columns > most:
            continue
        shown = along_rows(found, columns)
        legend = place.legend(shown.values(), shown, ncols=columns, **look)
        if columns == 1 or legend.get_window_extent().width <= width:
            return
        legend.remove()


def legend_above(ax: Any, columns: int = MOST, **more: Any) -> None:
    """A legend over the axes, where it hides no data, in as many columns as are no wider."""
    look = {"loc": "lower left", "bbox_to_anchor": (0, 1), "borderaxespad": 0.2, **more}
    legend_in_rows(ax, entries([ax]), WIDER * ax.bbox.width, columns, **look)


def legend_of(figure: Any, panels: Iterable[Any], **look: Any) -> None:
    """One legend for all panels of a figure, above them."""
    width = float(figure.bbox.width)
    legend_in_rows(figure, entries(panels), width, loc="outside upper center", **look)
