"""A channel whose walls are cosines."""

from typing import Literal

from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, param, tag
from mesokit.geometry.region import Region, Room, union, wave
from mesokit.geometry.shape_protocol import Shape


@component
class CosineChannel(Shape):
    """Fluid between two cosines, in the middle of the box: wide and narrow, or winding.

    Half its width is `width`/2 + amplitude cos(2 pi waves s/L) where it is wide and narrow; where
    it winds, its middle is displaced by that cosine and the width is the same everywhere.
    """

    shape: Literal["cosine-channel"] = tag("cosine-channel")
    axis: Axis = param("x", doc="axis along the channel")
    across: Axis = param("y", doc="axis across it")
    width: float = param(doc="mean width", unit="a", gt=0)
    amplitude: float = param(doc="amplitude of each wall", unit="a", gt=0)
    waves: int = param(1, doc="number of waves in the box", ge=1)
    winding: bool = param(False, doc="walls in parallel instead of as mirror images")

    def __post_init__(self) -> None:
        if self.axis == self.across:
            raise ValueError(f"across = {self.across!r}: expected another axis than axis")
        if not self.winding and 2 * self.amplitude >= self.width:
            raise ValueError(
                f"amplitude = {self.amplitude:g}: expected less than half the width, "
                f"{self.width / 2:g}, or the channel closes"
            )

    def body(self, room: Room) -> Region:
        """The region beyond both walls."""
        along, across = AXES.index(self.axis), AXES.index(self.across)
        per_length = self.waves / room.size[along]
        middle = 0.5 * room.size[across]
        walls = []
        for side in (-1, 1):  # below the channel, above it
            place = [0.0] * room.dimension
            place[across] = middle + 0.5 * side * self.width
            shift = self.winding or side > 0
            place[along] = 0.0 if shift else 0.5 / per_length
            walls.append(wave(place, along, across, self.amplitude, per_length, above=side < 0))
        return union(walls)

    def pivot(self, room: Room) -> tuple[float, ...]:
        return tuple(0.5 * length for length in room.size)
