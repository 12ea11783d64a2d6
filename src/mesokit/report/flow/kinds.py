"""The kinds of pictures. A new one is a file here and a name in `KINDS`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.method.protocol import method_of
from mesokit.report.flow import (
    birds,
    density,
    disks,
    particles,
    quiver,
    speed,
    streamlines,
    vorticity,
)
from mesokit.report.flow.data import Flow
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale

if TYPE_CHECKING:
    from mesokit.case.case import Case


class Panel(Protocol):
    """How one panel is drawn: a module.

    NEEDS: "velocity", "density", "particles", "spheres" or "headings"; TITLE: its name where
    several are side by side.
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
    "flock": (birds,),
    "four": (quiver, streamlines, particles, density),
}


def quieted(
    panels: Sequence[Panel], flows: Sequence[Flow], region: Region
) -> tuple[float, Callable[[Flow], str]]:
    """How wide velocities are smoothed for slopes of these panels, and what to say of it."""
    if vorticity not in panels:
        return 0.0, lambda flow: ""
    width, clear = vorticity.smoothing(flows, region)
    return width, lambda flow: vorticity.note(flow, clear)


def panels_of(kind: str, case: Case, colour: str | None = None) -> tuple[Panel, ...]:
    """The panels of a kind of picture. Raises CaseError for an unknown one, one of what the
    particles of the case have not, and a choice of colours that it does not have."""
    if kind not in KINDS:
        known = list(KINDS)
        raise CaseError(f"kind = {show(kind)}: expected {one_of(known)}{nearest(str(kind), known)}")
    of_spheres = any(panel.NEEDS == "spheres" for panel in KINDS[kind])
    if colour is not None and not of_spheres:
        raise CaseError(
            f"colour = {show(colour)}: not with kind {show(kind)}; expected 'disks', of spheres"
        )
    if of_spheres and not method_of(case).spheres:
        raise CaseError(
            f"kind = {show(kind)}: particles of method {show(case.run.method)} have no size; "
            "expected 'particles', or another kind"
        )
    return KINDS[kind]
