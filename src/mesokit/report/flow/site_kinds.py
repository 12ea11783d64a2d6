"""Kinds of pictures of the sites of a lattice that are no panels over two axes of the box."""

from typing import Any

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.flow.heights import Heights
from mesokit.report.flow.occupied import Occupied
from mesokit.report.flow.profiles import Profiles
from mesokit.report.flow.region import View
from mesokit.report.flow.site_frames import SiteFrames
from mesokit.report.flow.site_picture import SitePicture
from mesokit.report.flow.space_time import SpaceTime
from mesokit.report.flow.state import State
from mesokit.report.style import STYLE

SITE_KINDS: dict[str, type[SitePicture]] = {
    "space-time": SpaceTime,
    "profiles": Profiles,
    "heights": Heights,
    "occupied": Occupied,
}
NOT_HERE = ("region", "axes", "at", "colour", "average")


def own_kind(case: Case) -> str | None:
    """The kind of these by which the case is shown unless another is chosen."""
    own = case.groups[0].picture if case.groups else ""
    return own if own in SITE_KINDS else None


def site_picture(
    kind: str, case: Case, trajectory: TrajectoryReader | State | None, view: View
) -> SitePicture:
    """A picture of one of these kinds, of the frames in the window. Raises CaseError, RunError."""
    import matplotlib as mpl

    for choice in NOT_HERE:
        if (value := getattr(view, choice)) is not None:
            raise CaseError(f"{choice} = {show(value)}: not with kind {show(kind)}; leave it out")
    if view.states is not None and SITE_KINDS[kind] is not Occupied:
        raise CaseError(
            f"states = {show(list(view.states))}: not with kind {show(kind)}; expected 'occupied'"
        )
    with mpl.rc_context(STYLE):
        return SITE_KINDS[kind](SiteFrames(kind, case, trajectory, view))


def site_still(
    kind: str, case: Case, trajectory: TrajectoryReader | State | None, view: View
) -> Any:
    """A figure of the last frame in the window, or of all."""
    import matplotlib as mpl

    drawn = site_picture(kind, case, trajectory, view)
    with mpl.rc_context(STYLE):
        drawn.still()
    return drawn.figure
