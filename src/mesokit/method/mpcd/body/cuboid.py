"""A cuboid that moves in the fluid."""

from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, brick
from mesokit.geometry.shape_protocol import positive
from mesokit.method.mpcd.body.protocol import Body


@component
class CuboidBody(Body):
    """A cuboid (3D) along the axes of its own frame."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    shape: Literal["cuboid"] = tag("cuboid")
    size: Many[float] = param(doc="its sides", unit="a", min_length=3, max_length=3)

    _positive = field_validator("size")(positive)

    def region(self) -> Region:
        return brick((0.0, 0.0, 0.0), self.size)
