"""A cuboid, in 3D."""

from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, Room, brick
from mesokit.geometry.shape_protocol import Centred, Movable, positive


@component
class Cuboid(Centred, Movable):
    """A cuboid (3D), turned about z by an angle."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    per_axis = ("centre", "size")
    shape: Literal["cuboid"] = tag("cuboid")
    centre: Many[float] = param(doc="its centre", unit="a")
    size: Many[float] = param(doc="its sides", unit="a")
    angle: float = param(0.0, doc="turn about z, counter-clockwise", unit="degrees")

    _positive = field_validator("size")(positive)

    def body(self, room: Room) -> Region:
        return brick(self.centre, self.size, self.angle)
