"""Frames of the sites of a lattice, for pictures of them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.case.sites import SiteLattice
from mesokit.case.trajectory import Group
from mesokit.errors import CaseError, RunError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.caption import at
from mesokit.report.flow.region import View, frames_in
from mesokit.report.flow.state import State

PER_DECADE = 24  # frames of a film, where time is logarithmic
SPACINGS = ("linear", "log")
NEEDED = '[trajectory] with fields = ["site"]'
Numbers = NDArray[np.int64]


class SiteFrames:
    """Frames of the sites of a group, those in the window of a view. Raises CaseError, RunError.

    `time` (frames,) and `step`; `names` of the states, none of heights.
    """

    def __init__(
        self, kind: str, group: Group, reader: TrajectoryReader | State | None, view: View
    ) -> None:
        assert group.lattice is not None
        if reader is None or "site" not in reader.fields or not len(reader):
            raise RunError(
                f"{kind}: this picture needs states of sites, and the run kept none of them; "
                f"add to the case and run it again: {NEEDED}"
            )
        require_spacing(view.time)
        self.reader, self.view = reader, view
        self.lattice: SiteLattice = group.lattice
        self.names: tuple[str, ...] = group.states
        self.frames = frames_in(reader.time, view.window)
        self.time = np.asarray(reader.time, float)[self.frames]

    def __len__(self) -> int:
        return len(self.frames)

    def at(self, index: int) -> Numbers:
        """Numbers of the states, or heights, of all sites in a frame, in the shape of the
        lattice."""
        found = self.reader[int(self.frames[index])]["site"]
        return np.asarray(found, np.int64).reshape(self.lattice.size)

    def title(self, index: int) -> str:
        """The time of a frame."""
        return at(float(self.time[index]), 6)

    def chosen(self) -> list[int]:
        """Numbers of the states of `View.states`; unless said all but the first."""
        if self.view.states is None:
            return list(range(min(1, len(self.names) - 1), len(self.names)))
        for name in self.view.states:
            if name not in self.names:
                raise CaseError(
                    f"states = {show(list(self.view.states))}: expected {one_of(self.names)}"
                    f"{nearest(name, self.names)}"
                )
        return [self.names.index(name) for name in self.view.states]


def require_spacing(time: str | None) -> None:
    """Raise CaseError for a spacing of times that there is not."""
    if time is not None and time not in SPACINGS:
        raise CaseError(
            f"time = {show(time)}: expected {one_of(SPACINGS)}{nearest(time, SPACINGS)}"
        )


def lattice_group(case: Case) -> Group | None:
    """The group of sites of a case, if there is one."""
    return next((group for group in case.groups if group.lattice is not None), None)


def evenly(number: int, most: int) -> NDArray[np.int64]:
    """At most so many of a number of frames, evenly spaced, the first and the last among them.

    >>> evenly(5, 3).tolist(), evenly(2, 3).tolist()
    ([0, 2, 4], [0, 1])
    """
    found: Any = np.unique(np.linspace(0, number - 1, min(number, most)).round().astype(int))
    return np.asarray(found, np.int64)


def geometric(time: NDArray[np.floating[Any]], per_decade: float) -> NDArray[np.int64]:
    """Frames at times spaced geometrically, so many in a decade, each once: the last one at or
    before each time. The first and the last frame are among them.

    >>> geometric(np.arange(101.0), 1).tolist(), geometric(np.arange(9.0), 100).tolist()
    ([0, 1, 10, 100], [0, 1, 2, 3, 4, 5, 6, 7, 8])
    """
    late = time[time > 0]
    if not len(late):
        return np.arange(len(time))
    decades = float(np.log10(late[-1] / late[0]))
    count = int(np.ceil(decades * per_decade - 1e-9)) + 1
    wanted = late[0] * (late[-1] / late[0]) ** np.linspace(0, 1, max(count, 2))
    found = np.searchsorted(time, wanted * (1 + 1e-9), side="right") - 1
    return np.unique(np.concatenate([[0], found, [len(time) - 1]])).astype(np.int64)
