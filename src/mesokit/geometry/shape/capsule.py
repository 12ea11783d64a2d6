"""A rod with round ends."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, Room, capsule
from mesokit.geometry.shape_protocol import Movable


@component
class Capsule(Movable):
    """All places within a radius of the straight line between two ends."""

    per_axis = ("start", "end")
    shape: Literal["capsule"] = tag("capsule")
    start: Many[float] = param(doc="centre of one round end", unit="a")
    end: Many[float] = param(doc="centre of the other", unit="a")
    radius: float = param(doc="its radius", unit="a", gt=0)

    def __post_init__(self) -> None:
        if self.start == self.end:
            raise ValueError("end = start: expected another place; a ball is a disk or a sphere")

    def body(self, room: Room) -> Region:
        return capsule(self.start, self.end, self.radius)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return tuple(0.5 * (a + b) for a, b in zip(self.start, self.end, strict=True))

    def axis_of_rotation(self, room: Room) -> tuple[float, ...]:
        if room.dimension == 2:
            return (0.0, 0.0, 1.0)
        span = [b - a for a, b in zip(self.start, self.end, strict=True)]
        size = sum(x * x for x in span) ** 0.5
        return tuple(x / size for x in span)
