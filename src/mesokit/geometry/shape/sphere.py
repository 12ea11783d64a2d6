"""A sphere."""

from typing import ClassVar, Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, Room, ball
from mesokit.geometry.shape_protocol import Centred, Movable


@component
class Sphere(Centred, Movable):
    """A sphere (3D)."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    shape: Literal["sphere"] = tag("sphere")
    centre: Many[float] = param(doc="its centre", unit="a")
    radius: float = param(doc="its radius", unit="a", gt=0)

    def body(self, room: Room) -> Region:
        return ball(self.centre, self.radius)
