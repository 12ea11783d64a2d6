"""How figures look: readable in print, in grey, and on a projector."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import Any

from mesokit.report.caption import mathematics, symbols

WIDTH, HEIGHT = 6.4, 4.8  # inches
WIDER = 1.1  # than axes are before margins are taken away, what a legend above may be
MARKERS = "osD^v<>pP*X"
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
LETTERS = "abcdefghijkl"  # of panels
# dark enough for white paper, and each of its own grey
COLOURS = ("#1b4f8a", "#d4552a", "#1f7346", "#57206b", "#bd8f1c", "#222222")
STYLE: Any = {
    "text.usetex": False,  # users' settings apply but for this: TeX may not be there
    "font.size": 10,
    "axes.labelsize": 11,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "errorbar.capsize": 2,
    "lines.markersize": 4,
    "savefig.dpi": 200,
}


def looks() -> Iterator[tuple[Any, str]]:
    """Dash and colour of one curve after another, for pictures with many lines.

    >>> [dash for dash, colour in itertools.islice(looks(), 3)]
    ['-', '--', '-.']
    >>> len(set(itertools.islice(looks(), 36)))
    36
    """
    for i in itertools.count():
        yield LINES[i % len(LINES)], COLOURS[(i + i // len(LINES)) % len(COLOURS)]


def labelled(label: str, unit: str) -> str:
    """An axis label with its unit."""
    return f"{mathematics(label)}  [{symbols(unit)}]" if unit else mathematics(label)


def lettered(panels: Sequence[Any]) -> None:
    """Letters (a), (b), ... before the titles of several panels, or in their place."""
    for letter, ax in zip(LETTERS, panels, strict=False):
        if len(panels) > 1:
            title = next(filter(None, map(ax.get_title, ("left", "center"))), "")
            ax.set_title("")
            ax.set_title(f"({letter}) {title}".rstrip(), loc="left", fontsize=10)


def legend_above(ax: Any, columns: int = 3) -> None:
    """A legend over the axes, where it hides no data, in as many columns as are no wider."""
    if not ax.get_legend_handles_labels()[0]:
        return
    for number in range(columns, 0, -1):
        legend = ax.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=number, borderaxespad=0.2)
        if legend.get_window_extent().width <= WIDER * ax.bbox.width:
            return


def sparse_logarithm(axis: Any, least: float, most: float) -> None:
    """Numbers on a logarithmic axis that do not run into one another: powers of ten, and where
    there are less than two of these also 2 and 5 times as much."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    few = least > 0 and most / least < 100
    shown = FuncFormatter(lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "")
    axis.set_minor_formatter(shown if few else NullFormatter())
    if few:
        axis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
