"""An ellipsoid of revolution, in 3D."""

from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.box import Axis
from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Either, Many
from mesokit.geometry.region import Region, Room, ellipsoid
from mesokit.geometry.shape_protocol import Centred, Movable, a_direction, unit_vector


@component
class Spheroid(Centred, Movable):
    """An ellipsoid of revolution (3D): long as a rice grain, or flat as a lentil."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    shape: Literal["spheroid"] = tag("spheroid")
    centre: Many[float] = param(doc="its centre", unit="a")
    radius: float = param(doc="its radius across its axis, at the equator", unit="a", gt=0)
    half_length: float = param(doc="from its centre to an end of its axis", unit="a", gt=0)
    axis: Either[Axis, float] = param("z", doc="its direction: 'x', 'y', 'z' or a vector")

    _a_direction = field_validator("axis")(a_direction)

    def body(self, room: Room) -> Region:
        return ellipsoid(self.centre, unit_vector(self.axis), self.half_length, self.radius)

    def axis_of_rotation(self, room: Room) -> tuple[float, ...]:
        return unit_vector(self.axis)
