"""Which part of the box, and which part of the run, a picture shows."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.report.flow.data import Array

Ranges = Sequence[Sequence[float]]
FEWEST = 2  # bins along each axis


class View(NamedTuple):
    """Which part of the box is shown: a region, a window of time, a plane and where it lies.

    `colour` says what the colours of spheres mean, `average` how many frames each picture of a film
    is the mean of. `states` are those of sites that are balls in space. `time` is "linear" or
    "log": how the times of a film, or of profiles, are spaced. `traces` is the time over which the
    paths of bodies are shown.
    """

    region: Ranges | None = None
    window: tuple[float, float] | None = None
    axes: tuple[str, str] | None = None
    at: float | None = None
    colour: str | None = None
    average: int | None = None
    states: Sequence[str] | None = None
    time: str | None = None
    traces: float | None = None


CHOICES = View._fields


def require_none(view: View, choices: Sequence[str]) -> None:
    """Raise CaseError for one of these choices, which this picture does not have."""
    for choice in choices:
        if (value := getattr(view, choice)) is not None:
            raise CaseError(f"{choice} = {show(value)}: not with this kind; leave it out")


@dataclass(frozen=True)
class Region:
    """A rectangle of the box, in cells."""

    low: tuple[float, float]
    high: tuple[float, float]

    @property
    def extent(self) -> tuple[float, float]:
        """Lengths of its sides."""
        return self.high[0] - self.low[0], self.high[1] - self.low[1]

    def bins(self, size: tuple[float, float], shape: tuple[int, ...]) -> tuple[slice, slice]:
        """The bins, of `shape` in a box of `size`, that overlap with it.

        Raises CaseError if they are too few to draw.
        """
        width = [length / n for length, n in zip(size, shape, strict=False)]
        first = [int(np.floor(a / w + 1e-9)) for a, w in zip(self.low, width, strict=True)]
        last = [int(np.ceil(b / w - 1e-9)) for b, w in zip(self.high, width, strict=True)]
        for a, b, w in zip(first, last, width, strict=True):
            if b - a < FEWEST:
                raise CaseError(
                    f"region = {show([*zip(self.low, self.high, strict=True)])}: expected at least "
                    f"{FEWEST} bins along each axis, which are {w:g} cells wide"
                )
        return slice(first[0], last[0]), slice(first[1], last[1])

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """Which of the points (n, 2) lie in it."""
        return np.all((points >= self.low) & (points <= self.high), axis=1)


def region_of(given: Ranges | None, axes: tuple[str, str], size: tuple[float, float]) -> Region:
    """The region that a user gave, the whole box for None. Raises CaseError."""
    if given is None:
        return Region((0.0, 0.0), size)
    try:
        (x0, x1), (y0, y1) = ((float(a), float(b)) for a, b in given)
    except (TypeError, ValueError):
        raise CaseError(
            f"region = {show(given)}: expected ((x0, x1), (y0, y1)), two numbers for each axis"
        ) from None
    if not (0 <= x0 < x1 <= size[0] and 0 <= y0 < y1 <= size[1]):
        raise CaseError(
            f"region = {show([(x0, x1), (y0, y1)])}: expected parts of the box, "
            f"{axes[0]} from 0 to {size[0]:g} and {axes[1]} from 0 to {size[1]:g}"
        )
    return Region((x0, y0), (x1, y1))


def frames_in(time: Array, window: Any) -> NDArray[np.int64]:
    """Which frames lie in the window (t0, t1), all for None. Raises CaseError."""
    if window is None:
        return np.arange(len(time))
    try:
        start, end = (float(t) for t in window)
    except (TypeError, ValueError):
        raise CaseError(f"window = {show(window)}: expected (t0, t1), two times") from None
    if not start < end:
        raise CaseError(f"window = {show([start, end])}: expected the earlier time first")
    found = np.flatnonzero((time >= start) & (time <= end))
    if not len(found):
        raise CaseError(
            f"window = {show([start, end])}: no frame in it; there are {len(time)}, "
            f"from t = {time[0]:g} to {time[-1]:g}"
        )
    return found
