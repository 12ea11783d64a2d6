"""An ellipse that moves in the fluid."""

from typing import ClassVar, Literal

from pydantic import field_validator

from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Many
from mesokit.geometry.region import Region, ellipsoid
from mesokit.geometry.shape_protocol import positive
from mesokit.method.mpcd.body.protocol import Body


@component
class EllipseBody(Body):
    """An ellipse (2D), with its axes along those of its own frame."""

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    squirms: ClassVar[bool] = True
    shape: Literal["ellipse"] = tag("ellipse")
    size: Many[float] = param(doc="its axes", unit="a", min_length=2, max_length=2)

    _positive = field_validator("size")(positive)

    @property
    def half_axis(self) -> float:
        return 0.5 * self.size[0]

    @property
    def aspect(self) -> float:
        return self.size[0] / self.size[1]

    def region(self) -> Region:
        return ellipsoid((0.0, 0.0), (1.0, 0.0), 0.5 * self.size[0], 0.5 * self.size[1])
