"""Everything behind a plane."""

from typing import Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, Room, half_space
from mesokit.geometry.shape_protocol import Simple


@component
class HalfSpace(Simple):
    """Everything behind a plane, such as a floor or an inclined wall."""

    per_axis = ("point", "normal")
    shape: Literal["half-space"] = tag("half-space")
    point: Many[float] = param(doc="a place on the plane", unit="a")
    normal: Many[float] = param(doc="direction from the plane into the fluid")

    @field_validator("normal")
    @classmethod
    def _a_direction(cls, normal: tuple[float, ...]) -> tuple[float, ...]:
        if not any(normal):
            raise ValueError("expected a direction, not all zero")
        return normal

    def body(self, room: Room) -> Region:
        return half_space(self.point, self.normal)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return self.point
