"""The kinds of pictures. A new one is a file here and a name in `KINDS`."""

from collections.abc import Sequence
from typing import Any, Protocol

from mesokit.case.case import Case
from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.report.flow import (
    birds,
    body_panel,
    disks,
    force_chains,
    particles,
    quiver,
    sites,
    streamlines,
)
from mesokit.report.flow.data import Flow
from mesokit.report.flow.maps import LINES, density, speed, vorticity
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale
from mesokit.report.flow.site_frames import lattice_group
from mesokit.report.flow.site_kinds import SITE_KINDS, require_fitting
from mesokit.report.flow.source import Found
from mesokit.seam.method import method_of


class Panel(Protocol):
    """One panel of a picture: a module, or an object of a class.

    NEEDS: "velocity", "density", "particles", "spheres", "contacts", "headings", "bodies" or
    "sites"; TITLE: its name where several are side by side.
    """

    NEEDS: str
    TITLE: str

    def reach(self, flow: Flow, region: Region) -> float:
        """The largest number shown, so that all pictures of a film can have the same scale."""

    def scale(self, flow: Flow, reach: float) -> Scale | None:
        """Its colours, None without any."""

    def draw(self, ax: Any, flow: Flow, region: Region, reach: float) -> None:
        """Draw what changes from one picture of a film to the next."""


KINDS: dict[str, tuple[Panel, ...]] = {
    "quiver": (quiver,),
    "streamlines": (streamlines,),
    "particles": (particles,),
    "density": (density,),
    "speed": (speed,),
    "vorticity": (vorticity,),
    "disks": (disks,),
    "force-chains": (force_chains,),
    "flock": (birds,),
    "bodies": (body_panel,),
    "sites": (sites,),
    "four": (quiver, streamlines, particles, density),
}


NAMES = (*KINDS, *SITE_KINDS)


def legend_of(panels: Sequence[Panel]) -> str:
    """Meaning of lines in the panels that no bar of colours has."""
    return LINES if vorticity in panels else ""


def usual(case: Case, found: Found, first: str, in_time: bool) -> str:
    """The kind of picture unless another is chosen: the first for which a run has kept all.

    That of the method, then `first`, then what needs less. Where nothing is enough it is the first
    of these, whose refusal says what to add to the case.
    """
    own = case.groups[0].picture if case.groups else ""
    if own in SITE_KINDS:
        return own
    if own and own not in KINDS:
        raise CaseError(f"method {show(case.run.method)}: picture = {show(own)}: {_expected(own)}")
    wanted = [own or first, first, "speed", "density", "bodies", "particles"]
    for kind in wanted:
        needs = {panel.NEEDS for panel in KINDS[kind]}
        drawn = [source for source in found if len(source.time) or not in_time]
        alone = any(needs <= source.gives for source in drawn)
        if alone or (not in_time and all(any(n in s.gives for s in drawn) for n in needs)):
            return kind
    return wanted[0]


def _expected(kind: object) -> str:
    return f"expected {one_of(NAMES)}{nearest(str(kind), NAMES)}"


def panels_of(kind: str, case: Case, colour: str | None = None) -> tuple[Panel, ...]:
    """The panels of a kind of picture. Raises CaseError for an unknown one, one of what the
    particles of the case have not, and a choice of colours that it does not have."""
    if kind not in KINDS:
        raise CaseError(f"kind = {show(kind)}: {_expected(kind)}")
    of_spheres = any(panel.NEEDS == "spheres" for panel in KINDS[kind])
    if colour is not None and not of_spheres:
        raise CaseError(
            f"colour = {show(colour)}: not with kind {show(kind)}; expected 'disks', of spheres"
        )
    if of_spheres and not case.particles_have("diameter"):
        raise CaseError(
            f"kind = {show(kind)}: particles of method {show(case.run.method)} have no size; "
            "expected 'particles', or another kind"
        )
    if kind == "bodies" and not method_of(case).bodies(case):
        raise CaseError("kind = 'bodies': the case has no bodies that move; expected another kind")
    touch = any(panel.NEEDS == "contacts" for panel in KINDS[kind])
    if touch and not case.particles_have("contact"):
        raise CaseError(
            f"kind = {show(kind)}: particles of method {show(case.run.method)} have no contacts "
            "that last; expected another kind"
        )
    group = lattice_group(case)
    if group is not None:
        require_fitting(kind, case, group)
    return KINDS[kind]
