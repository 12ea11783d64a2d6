"""A rod with round ends that moves in the fluid."""

from typing import ClassVar, Literal

from mesokit.case.component import component, param, show, tag
from mesokit.geometry.region import Region, capsule
from mesokit.method.mpcd.body.protocol import Body


@component
class CapsuleBody(Body):
    """A rod with round ends along its axis x."""

    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    shape: Literal["capsule"] = tag("capsule")
    length: float = param(doc="from end to end", unit="a", gt=0)
    radius: float = param(doc="its radius", unit="a", gt=0)

    def __post_init__(self) -> None:
        super(CapsuleBody, self).__post_init__()  # noqa: UP008  the decorator makes a new class
        if self.length <= 2.0 * self.radius:
            raise ValueError(f"length = {show(self.length)}: expected more than 2 radius")

    def region(self) -> Region:
        half = 0.5 * self.length - self.radius
        return capsule((-half, 0.0, 0.0), (half, 0.0, 0.0), self.radius)
