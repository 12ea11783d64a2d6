"""Where spheres start from. A new start is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.spheres.common.start.protocol import Placed, SphereStart

__getattr__ = parts_in(__name__, STARTS=SphereStart)

__all__ = ["STARTS", "Placed", "SphereStart"]
