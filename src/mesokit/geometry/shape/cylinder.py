"""A round cylinder without ends, in 3D; with the fluid inside, a round pipe."""

from typing import Any, ClassVar, Literal

from pydantic import field_validator

from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Either, Many
from mesokit.geometry.region import Region, Room, rod
from mesokit.geometry.shape_protocol import Centred, Simple


@component
class Cylinder(Centred, Simple):
    """A round cylinder through the whole box (3D), along any direction that fits the box."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    shape: Literal["cylinder"] = tag("cylinder")
    centre: Many[float] = param(doc="a place on its axis", unit="a")
    radius: float = param(doc="its radius", unit="a", gt=0)
    axis: Either[Axis, float] = param("z", doc="its direction: 'x', 'y', 'z' or a vector")

    @field_validator("axis")
    @classmethod
    def _a_direction(cls, axis: Any) -> Any:
        if isinstance(axis, tuple) and not (len(axis) == 3 and any(axis)):
            raise ValueError("expected 'x', 'y', 'z' or three numbers, not all zero")
        return axis

    @property
    def direction(self) -> tuple[float, ...]:
        """Unit vector along the axis."""
        if isinstance(self.axis, str):
            return tuple(1.0 * (letter == self.axis) for letter in AXES)
        size = sum(x * x for x in self.axis) ** 0.5
        return tuple(x / size for x in self.axis)

    def body(self, room: Room) -> Region:
        return rod(self.centre, self.direction, self.radius)

    def axis_of_rotation(self, room: Room) -> tuple[float, ...]:
        return self.direction
