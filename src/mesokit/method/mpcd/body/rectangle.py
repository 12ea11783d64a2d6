"""A rectangle that moves in the fluid."""

from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, brick
from mesokit.geometry.shape_protocol import positive
from mesokit.method.mpcd.body.protocol import Body


@component
class RectangleBody(Body):
    """A rectangle (2D) along the axes of its own frame."""

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    shape: Literal["rectangle"] = tag("rectangle")
    size: Many[float] = param(doc="its sides", unit="a", min_length=2, max_length=2)

    _positive = field_validator("size")(positive)

    def region(self) -> Region:
        return brick((0.0, 0.0), self.size)
