"""Where panels and colour bars stand, in inches: a panel has the shape of what it shows."""

import contextlib
from collections.abc import Iterator, Sequence
from contextvars import ContextVar
from dataclasses import dataclass
from typing import NamedTuple

PAGE, TALLEST = 6.4, 5.2  # widest figure with one panel in a row; height of all panels
WIDE_PAGE = 8.2  # widest figure with several
LOWEST = 0.35  # panel with room for its label
LEFT, BOTTOM, TOP = 0.72, 0.56, 0.34
BARE = 0.12  # above a panel without title and key
GAP = 0.3  # on the right of a panel without a colour bar
BAR, BAR_ROOM = 0.14, 0.98  # colour bar on the right, with its numbers and label
APART = 0.2  # more of it where another panel follows, whose ticks would stand at the label
SLENDER = 2.2  # ratio of the sides beyond which panels stand in one row or column
FLAT_BAR, FLAT_ROOM = 0.09, 0.48  # colour bar above a flat panel
KEY_BESIDE, KEY_ROOM = 1.9, 0.22  # width of a panel that has title and key above it in one line
STAMP = 0.22  # for the time, above everything
LINE = 0.16  # of the note below everything


class Box(NamedTuple):
    """Left, bottom, width and height."""

    left: float
    bottom: float
    width: float
    height: float


@dataclass(frozen=True)
class Layout:
    """A figure of `size`, `panels` in it, and for each a colour bar, used or not.

    flat: colour bars lie above the panels, else they stand on the right.
    """

    size: tuple[float, float]
    panels: list[Box]
    bars: list[Box]
    flat: bool
    columns: int


_WIDTH: ContextVar[float | None] = ContextVar("width of the page", default=None)


@contextlib.contextmanager
def page_width(width: float | None) -> Iterator[None]:
    """Pictures that are made within are so wide, in inches, with one panel in a row if narrow."""
    before = _WIDTH.set(width)
    try:
        yield
    finally:
        _WIDTH.reset(before)


def width_of_page() -> float:
    """Width of a figure with one panel, in inches."""
    return _WIDTH.get() or PAGE


def layout(
    extent: tuple[float, float], bars: Sequence[bool], stamp: bool, lines: int = 0
) -> Layout:
    """Room for panels that show a region of `extent`.

    Parameters
    ----------
    extent: lengths of the region along the two axes.
    bars: for each panel, whether it has a colour bar. Several stand in pairs, flat ones below one
        another, narrow ones in one row.
    stamp: whether the time is written above.
    lines: of the note below.
    """
    bottom = BOTTOM + LINE * lines
    count, flat = len(bars), extent[0] > SLENDER * extent[1]
    narrow = extent[1] > SLENDER * extent[0]
    page = _WIDTH.get()
    columns = 1 if flat or (page or PAGE) < PAGE else count if narrow else min(count, 2)
    rows = -(-count // columns)
    rights = [
        BAR_ROOM + APART * (column + 1 < columns)
        if not flat and any(bars[column::columns])
        else GAP
        for column in range(columns)
    ]
    room = (page or (PAGE if columns == 1 else WIDE_PAGE)) - LEFT - sum(rights)
    scale = min(room / columns / extent[0], TALLEST / min(rows, 2) / extent[1])
    width, height = scale * extent[0], max(LOWEST, scale * extent[1])
    top = FLAT_ROOM if flat and (any(bars) or count > 1) else TOP
    if count == 1 and all(bars) and not flat:
        top = BARE
    if count > 1 and width < KEY_BESIDE:
        top += KEY_ROOM
    panels = [
        Box(
            LEFT + column * width + sum(rights[:column]),
            bottom + (rows - 1 - row) * (height + top),
            width,
            height,
        )
        for row, column in (divmod(number, columns) for number in range(count))
    ]
    size = LEFT + columns * width + sum(rights), bottom + rows * (height + top) + STAMP * stamp
    return Layout(size, panels, [_bar(panel, flat) for panel in panels], flat, columns)


def _bar(panel: Box, flat: bool) -> Box:
    if flat:
        length = 0.4 * panel.width
        left = panel.left + panel.width - length
        return Box(left, panel.bottom + panel.height + 0.07, length, FLAT_BAR)
    return Box(panel.left + panel.width + 0.1, panel.bottom, BAR, panel.height)
