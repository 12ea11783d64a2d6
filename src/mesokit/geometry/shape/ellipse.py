"""An ellipse, in 2D."""

import math
from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, Room, ellipsoid
from mesokit.geometry.shape_protocol import Centred, Movable, positive


@component
class Ellipse(Centred, Movable):
    """An ellipse (2D), turned by an angle: the largest in the rectangle of this size."""

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    per_axis = ("centre", "size")
    shape: Literal["ellipse"] = tag("ellipse")
    centre: Many[float] = param(doc="its centre", unit="a")
    size: Many[float] = param(doc="its two axes, from end to end", unit="a")
    angle: float = param(0.0, doc="turn, counter-clockwise", unit="degrees")

    _positive = field_validator("size")(positive)

    def body(self, room: Room) -> Region:
        turn, (along, across) = math.radians(self.angle), self.size
        return ellipsoid(self.centre, (math.cos(turn), math.sin(turn)), along / 2, across / 2)
