"""Where the numbers of a picture come from, among all that a run has kept."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError, RunError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.observe.flow_frames import FlowFrames
from mesokit.report.flow.data import Flow
from mesokit.report.flow.region import View
from mesokit.report.flow.state import State
from mesokit.seam.method import method_of
from mesokit.seam.result import Result

Axes = tuple[str, str]
ALL = View()
WORDS = {
    "velocity": "velocities",
    "density": "densities",
    "particles": "positions of particles",
    "spheres": "positions of spheres",
    "contacts": "contacts of spheres",
    "headings": "positions and velocities of particles",
    "bodies": "places and orientations of bodies",
    "sites": "states of sites",
}
PLACES = {"headings": "positions", "bodies": "places"}  # a part of these words, kept alone
AT_ONCE = (
    "particles",
    "spheres",
    "contacts",
    "headings",
    "bodies",
    "sites",
)  # shown at one time, and not as a mean
FRAMES = '[[observe]] quantity = "flow-frames"'
REMEDY = {
    "velocity": FRAMES,
    "density": FRAMES,
    "particles": f"{FRAMES} with particles > 0, or [trajectory]",
    "spheres": "[trajectory]",
    "contacts": '[trajectory] with fields = ["position", "contact"]',
    "headings": '[trajectory] with fields = ["position", "velocity"]',
    "bodies": '[trajectory] with of = "bodies", fields = ["position", "orientation"]',
    "sites": '[trajectory] with fields = ["site"]',
}
OF_TRAJECTORIES = {  # of methods that offer no flow-frames
    **REMEDY,
    "velocity": REMEDY["headings"],
    "density": REMEDY["spheres"],
    "particles": REMEDY["spheres"],
}


class Found(list["Source"]):
    """Sources over two axes, the axes of the maps that were kept but are over others, what would
    give what is not there, and of what the places were kept without the rest (`places`)."""

    def __init__(
        self, axes: Axes, others: Sequence[Axes] = (), remedy: Mapping[str, str] = REMEDY
    ) -> None:
        super().__init__()
        self.axes, self.others, self.remedy = axes, list(dict.fromkeys(others)), remedy
        self.places: set[str] = set()

    def lack(self, needs: str, kept: str) -> str:
        """Maps that were kept, and what to add to the case, if it lacks the maps."""
        if not self.others or needs in AT_ONCE:
            return f"{kept}; add to the case and run it again: {self.remedy[needs]}"
        maps = " and ".join(",".join(axes) for axes in self.others)
        return (
            f"maps over {maps}, not over {','.join(self.axes)}; add to the case and run it again: "
            f'{FRAMES}, axes = ["{self.axes[0]}", "{self.axes[1]}"]'
        )


class Source(Protocol):
    """Data of a run for pictures.

    gives: which of the `WORDS` it has.
    time: of its frames; empty if it has only the mean over the run.
    whole: the frames that average over as long a time as any.
    """

    axes: Axes
    gives: frozenset[str]
    time: NDArray[Any]
    whole: NDArray[np.int64]

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """Means over some frames, and particles as they are in the last of them."""


def sources(
    case: Case,
    results: Mapping[str, Result],
    trajectory: TrajectoryReader | State | None,
    view: View = ALL,
) -> Found:
    """Sources of pictures over two axes, best first. Unless said they are those of the first map,
    or show how spheres fall.

    A map over the same axes in the other order is turned.

    Raises CaseError for axes that the box has not, or of which no map was kept.
    """
    from mesokit.report.flow.bodies import without_turns
    from mesokit.report.flow.map_sources import FieldSource, FrameSource
    from mesokit.report.flow.setting import Setting
    from mesokit.report.flow.sites import SiteSource
    from mesokit.report.flow.spheres import SphereSource, from_the_side
    from mesokit.report.flow.trajectory_source import TrajectorySource

    kept = [result for result in results.values() if result.samples]
    maps: list[tuple[Axes, Result]] = []
    for drawing in ("frames", "map"):
        found_now = [r for r in kept if r.drawing == drawing]
        maps += [(axes_of(r), r) for r in sorted(found_now, key=lambda r: "component" not in r.x)]
    axes, known = view.axes, case.box.axes
    if len(known) < 2:
        raise CaseError(f"box.size = {show(list(case.box.size))}: expected two axes of a picture")
    if axes is not None and (len(axes) != 2 or axes[0] == axes[1] or not set(axes) <= set(known)):
        raise CaseError(f"axes = {show(axes)}: expected two of {', '.join(known)}")
    spheres = trajectory is not None and trajectory.diameter is not None
    usual = from_the_side(case.spheres.gravity) if spheres else ("x", "y")
    chosen = axes or (maps[0][0] if maps else usual)
    remedy = REMEDY if issubclass(FlowFrames, method_of(case).observables) else OF_TRAJECTORIES
    found = Found(chosen, [axes for axes, _ in maps if set(axes) != set(chosen)], remedy)
    for over, result in maps:
        if set(over) == set(chosen):
            make = FrameSource if result.drawing == "frames" else FieldSource
            found.append(make(Setting.of(case, chosen), result))
    if any("particles" in source.gives for source in found):
        found.places.add("headings")
    if trajectory is not None and "site" in trajectory.fields and len(trajectory):
        group = next(group for group in case.groups if "site" in group.has)
        found.append(SiteSource(case, trajectory, group, view._replace(axes=chosen)))
    if trajectory is not None and "position" in trajectory.fields and len(trajectory):
        found.append(TrajectorySource(case, trajectory, chosen))
        if (trajectory.id < case.particles).any():
            found.places.add("headings")
        if trajectory.diameter is not None:
            found.append(SphereSource(case, trajectory, view._replace(axes=chosen)))
    if without_turns(case, trajectory):
        found.places.add("bodies")
    return found


def axes_of(result: Result) -> Axes:
    """The two axes of a map."""
    first, second = [axis for axis in result.x if axis not in ("time", "component")]
    return first, second


def choose(found: Found, needs: str, kind: str, in_time: bool) -> Source:
    """The first source with the data of a panel, `in_time` one with frames.

    Raises RunError that says what to add to the case.
    """
    fitting = [source for source in found if needs in source.gives]
    timed = [source for source in fitting if len(source.time)]
    if in_time and timed:
        return timed[0]
    if fitting and not in_time:
        return fitting[0]
    kept = "only their mean over the whole run" if fitting else "none of them"
    if not fitting and needs in found.places:
        kept = f"their {PLACES[needs]} alone"
    raise RunError(
        f"{kind}: this picture needs {WORDS[needs]}{' in time' * in_time}, and the run kept "
        f"{found.lack(needs, kept)}"
    )


def choose_one(found: Found, needs: set[str], kind: str) -> Source:
    """The first source with frames that has the data of all panels of a film.

    Raises RunError that says what to add to the case.
    """
    for source in found:
        if needs <= source.gives and len(source.time):
            return source
    for need in sorted(needs):
        choose(found, need, kind, in_time=True)
    raise RunError(
        f"{kind}: the panels of this film need frames at the same times; "
        f"add to the case and run it again: {FRAMES} with particles > 0"
    )
