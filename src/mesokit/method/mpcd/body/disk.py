"""A disk that moves in the fluid."""

from typing import ClassVar, Literal

from mesokit.case.component import component, param, tag
from mesokit.geometry.region import Region, ball
from mesokit.method.mpcd.body.protocol import Body


@component
class DiskBody(Body):
    """A disk (2D)."""

    dimensions: ClassVar[tuple[int, ...]] = (2,)
    squirms: ClassVar[bool] = True
    tumbles: ClassVar[bool] = True
    shape: Literal["disk"] = tag("disk")
    radius: float = param(doc="its radius", unit="a", gt=0)

    @property
    def half_axis(self) -> float:
        return self.radius

    def region(self) -> Region:
        return ball((0.0,) * 2, self.radius)
