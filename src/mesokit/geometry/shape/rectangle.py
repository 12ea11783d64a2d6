"""A rectangle, in 2D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry import region
from mesokit.geometry.shape_protocol import Simple

if TYPE_CHECKING:
    from mesokit.geometry.region import Room


@component
class Rectangle(Simple):
    """A rectangle (2D), turned by an angle."""

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    shape: Literal["rectangle"] = tag("rectangle")
    centre: Many[float] = param(doc="its centre", unit="a")
    size: Many[float] = param(doc="its sides", unit="a")
    angle: float = param(0.0, doc="turn, counter-clockwise", unit="degrees")

    @field_validator("size")
    @classmethod
    def _positive(cls, size: tuple[float, ...]) -> tuple[float, ...]:
        if not all(x > 0 for x in size):
            raise ValueError("expected positive lengths")
        return size

    def body(self, room: Room) -> region.Region:
        return region.brick(self.centre, self.size, self.angle)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return self.centre

    def vectors(self) -> dict[str, Any]:
        return {"centre": self.centre, "size": self.size}
