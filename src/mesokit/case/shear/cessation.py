"""Cessation of steady shear: a steady shear rate, then rest."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.shear.two_ramps import InStages, Ramp


@component
class Cessation(InStages):
    """Cessation: a steady shear rate until `stop`, then none.

    With a `period` shear and rest follow one another.

    >>> history = Cessation(rate=0.1, stop=10.0)
    >>> history.rate_at(9.0), history.rate_at(11.0), float(history.strain_at(15.0))
    (0.1, 0.0, 1.0)
    """

    rule: Literal["cessation"] = tag("cessation")
    rate: float = param(
        doc="shear rate before it ceases", symbol=r"\dot\gamma", unit="1/time", ge=-1e6, le=1e6
    )
    stop: float = param(doc="time of shear", unit="time", gt=0, le=1e9)

    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        return self.rate, Ramp(-self.rate, self.stop, self.stop), None
