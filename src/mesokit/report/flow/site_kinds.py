"""Kinds of pictures of the sites of a lattice that are no panels over two axes of the box."""

from typing import Any

from mesokit.case.case import Case
from mesokit.case.component import one_of, show
from mesokit.case.trajectory import Group
from mesokit.errors import CaseError
from mesokit.io.trajectory_reader import TrajectoryReader
from mesokit.report.flow.heights import Heights
from mesokit.report.flow.occupied import Occupied
from mesokit.report.flow.profiles import Profiles
from mesokit.report.flow.region import View
from mesokit.report.flow.site_frames import SiteFrames, lattice_group
from mesokit.report.flow.site_picture import SitePicture, look
from mesokit.report.flow.space_time import SpaceTime
from mesokit.report.flow.state import State

SITE_KINDS: dict[str, type[SitePicture]] = {
    "space-time": SpaceTime,
    "profiles": Profiles,
    "heights": Heights,
    "occupied": Occupied,
}
NOT_HERE = ("region", "axes", "at", "colour", "average", "traces")


def own_kind(case: Case) -> str | None:
    """The kind of these by which the case is shown unless another is chosen."""
    own = case.groups[0].picture if case.groups else ""
    return own if own in SITE_KINDS else None


def require_fitting(kind: str, case: Case, group: Group) -> None:
    """Raise CaseError for a kind of pictures that does not show sites of a group."""
    assert group.lattice is not None
    plane = group.lattice.dimension > 1
    fitting = [name for name, each in SITE_KINDS.items() if each.fits(group)]
    fitting = ["sites"] * plane + fitting
    if kind not in fitting:
        what = {1: "a chain", 2: "a plane", 3: "space"}[group.lattice.dimension]
        of = "states" if group.states else "heights"
        raise CaseError(
            f"kind = {show(kind)}: {group.name} of method {show(case.run.method)} have {of} on "
            f"{what}; expected {one_of(fitting)}"
        )


def site_picture(
    kind: str, case: Case, trajectory: TrajectoryReader | State | None, view: View
) -> SitePicture:
    """A picture of one of these kinds, of the frames in the window. Raises CaseError, RunError."""
    import matplotlib as mpl

    group = lattice_group(case)
    if group is None:
        raise CaseError(
            f"kind = {show(kind)}: method {show(case.run.method)} has no lattice; expected a "
            "picture of particles or flow"
        )
    require_fitting(kind, case, group)
    for choice in NOT_HERE:
        if (value := getattr(view, choice)) is not None:
            raise CaseError(f"{choice} = {show(value)}: not with kind {show(kind)}; leave it out")
    if view.states is not None and SITE_KINDS[kind] is not Occupied:
        raise CaseError(
            f"states = {show(list(view.states))}: not with kind {show(kind)}; expected 'occupied'"
        )
    with mpl.rc_context(look()):
        return SITE_KINDS[kind](SiteFrames(kind, group, trajectory, view))


def site_still(
    kind: str, case: Case, trajectory: TrajectoryReader | State | None, view: View
) -> Any:
    """A figure of the last frame in the window, or of all."""
    import matplotlib as mpl

    drawn = site_picture(kind, case, trajectory, view)
    with mpl.rc_context(look()):
        drawn.still()
    return drawn.figure
