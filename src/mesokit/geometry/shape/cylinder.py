"""A round cylinder without ends, in 3D; with the fluid inside, a round pipe."""

from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.box import Axis
from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Either, Many
from mesokit.geometry.region import Region, Room, rod
from mesokit.geometry.shape_protocol import Centred, Simple, a_direction, unit_vector


@component
class Cylinder(Centred, Simple):
    """A round cylinder through the whole box (3D), along any direction that fits the box."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    shape: Literal["cylinder"] = tag("cylinder")
    centre: Many[float] = param(doc="a place on its axis", unit="a")
    radius: float = param(doc="its radius", unit="a", gt=0)
    axis: Either[Axis, float] = param("z", doc="its direction: 'x', 'y', 'z' or a vector")

    _a_direction = field_validator("axis")(a_direction)

    @property
    def direction(self) -> tuple[float, ...]:
        """Unit vector along the axis."""
        return unit_vector(self.axis)

    def body(self, room: Room) -> Region:
        return rod(self.centre, self.direction, self.radius)

    def axis_of_rotation(self, room: Room) -> tuple[float, ...]:
        return self.direction
