"""Step strain: a quick shear by so much, then rest."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.case.shear.two_ramps import InStages, Ramp


@component
class StepStrain(InStages):
    """Step strain: a shear by `strain` within `duration`, after which the box stays as it is.

    What the stress is afterwards, over the strain, is the relaxation modulus G(t).

    >>> history = StepStrain(strain=0.5, duration=2.0, start=10.0)
    >>> history.rate_at(11.0), float(history.strain_at(11.0)), float(history.strain_at(99.0))
    (0.25, 0.25, 0.5)
    """

    rule: Literal["step-strain"] = tag("step-strain")
    strain: float = param(doc="by how much it is sheared", ge=-1e6, le=1e6)
    duration: float = param(doc="time that this takes", unit="time", gt=0, le=1e9)
    start: float = param(0.0, doc="time of rest before it", unit="time", ge=0, le=1e9)

    def stages(self) -> tuple[float, Ramp, Ramp | None]:
        rate, end = self.strain / self.duration, self.start + self.duration
        return 0.0, Ramp(rate, self.start, self.start), Ramp(-rate, end, end)
