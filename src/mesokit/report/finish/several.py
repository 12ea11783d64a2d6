"""Several results in one plot, with a colour and a name for each."""

from collections.abc import Callable
from typing import Any
from weakref import WeakKeyDictionary

from mesokit.report.finish.legend import along_rows, entries
from mesokit.report.style import COLOURS

MEASURED, THEORY = "measured", "theory"  # how the labels of a drawing begin
PALETTE = [COLOURS[k] for k in (0, 2, 3, 4, 5, 1)]  # last what fits are drawn in
_NUMBER: WeakKeyDictionary[Any, int] = WeakKeyDictionary()  # of results that axes hold


def add(ax: Any, draw: Callable[[], None], label: str = "", colour: str = "") -> None:
    """Draw one more result into axes.

    Parameters
    ----------
    ax: the axes.
    draw: draws the result into them, in the first colour.
    label: name of its data in the legend, instead of "measured".
    colour: of its data; the next of the palette unless said. A drawing of several data sets keeps
        its colours unless one is said.
    """
    number = _NUMBER.get(ax, 0)
    _NUMBER[ax] = number + 1
    before, earlier = set(ax.get_children()), set(ax.get_legend_handles_labels()[1])
    limits = ax.get_xlim(), ax.get_ylim()
    draw()
    if number:  # show all that was and is drawn
        now = ax.get_xlim(), ax.get_ylim()
        x, y = ((min(a[0], b[0]), max(a[1], b[1])) for a, b in zip(limits, now, strict=True))
        ax.set(xlim=x, ylim=y)
    entries = zip(*ax.get_legend_handles_labels(), strict=True)
    new = [(handle, text) for handle, text in entries if not _known(handle, before)]
    single = any(text.startswith(MEASURED) for _, text in new)
    if label:
        given: set[str] = set()
        for handle, text in new:
            name = _named(text, label, single)
            handle.set_label("_again" if name in given else name)
            given.add(name)
    elif number:
        for handle, text in new:
            if text in earlier and not text.startswith(MEASURED):
                handle.set_label("_again")
    for handle, text in new:
        if text.startswith(THEORY) and text in earlier:
            handle.set_label("_again")
    colour = colour or (PALETTE[number % len(PALETTE)] if single and (number or label) else "")
    for artist in set(ax.get_children()) - before if colour else ():
        _paint(artist, colour)
    _renew_legend(ax)


def _known(handle: Any, before: set[Any]) -> bool:
    """Whether an entry of the legend was there before; of error bars, by their parts."""
    parts = [part for part in getattr(handle, "lines", ()) or () if part is not None]
    flat = [p for part in parts for p in (part if isinstance(part, tuple | list) else [part])]
    return any(part in before for part in flat or [handle])


def _named(text: str, label: str, single: bool) -> str:
    """The text of an entry of the legend, with the name of its drawing."""
    if text.startswith(MEASURED):
        return label
    if text.startswith(THEORY) and single:
        return text
    return f"{label}: {text}"


def _paint(artist: Any, colour: str) -> None:
    """Give an artist a colour, unless it is black or grey, as theory and frames are."""
    from matplotlib.collections import LineCollection
    from matplotlib.colors import to_rgb, to_rgba_array
    from matplotlib.lines import Line2D

    def grey(value: Any) -> bool:
        red, green, blue = to_rgb(value)
        return max(red, green, blue) - min(red, green, blue) < 0.02

    if isinstance(artist, Line2D) and not grey(artist.get_color()):
        artist.set_color(colour)
        if not grey(artist.get_markerfacecolor()):
            artist.set_markerfacecolor(colour)
        artist.set_markeredgecolor(colour)
    elif isinstance(artist, LineCollection) and not any(
        grey(one) for one in to_rgba_array(artist.get_colors())
    ):
        artist.set_color(colour)


def _renew_legend(ax: Any) -> None:
    """The legend again, where it was, with the names that there are now."""
    old = ax.get_legend()
    if old is None:
        return
    place, anchor = old._loc, old.get_bbox_to_anchor().transformed(ax.transAxes.inverted())
    shown = along_rows(entries([ax]), old._ncols)
    look = {"ncols": old._ncols, "borderaxespad": old.borderaxespad}
    ax.legend(shown.values(), shown, loc=place, bbox_to_anchor=(anchor.x0, anchor.y0), **look)
