"""A spheroid that moves in the fluid."""

from typing import ClassVar, Literal

from mesokit.case.component import component, param, tag
from mesokit.geometry.region import Region, ellipsoid
from mesokit.method.mpcd.body.protocol import Body


@component
class SpheroidBody(Body):
    """An ellipsoid of revolution (3D) about its axis x: prolate or oblate."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    squirms: ClassVar[bool] = True
    shape: Literal["spheroid"] = tag("spheroid")
    half_length: float = param(doc="from its centre to an end of the axis", unit="a", gt=0)
    radius: float = param(doc="its largest radius across the axis", unit="a", gt=0)

    @property
    def half_axis(self) -> float:
        return self.half_length

    @property
    def aspect(self) -> float:
        return self.half_length / self.radius

    def region(self) -> Region:
        return ellipsoid((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), self.half_length, self.radius)
