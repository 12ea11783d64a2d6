"""A disk, in 2D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry import region
from mesokit.geometry.shape_protocol import Simple

if TYPE_CHECKING:
    from mesokit.geometry.region import Room


@component
class Disk(Simple):
    """A disk (2D): the cross-section of a cylinder."""

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    shape: Literal["disk"] = tag("disk")
    centre: Many[float] = param(doc="its centre", unit="a")
    radius: float = param(doc="its radius", unit="a", gt=0)

    def body(self, room: Room) -> region.Region:
        return region.ball(self.centre, self.radius)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return self.centre

    def vectors(self) -> dict[str, Any]:
        return {"centre": self.centre}
