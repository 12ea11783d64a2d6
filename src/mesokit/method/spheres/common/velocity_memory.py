"""How long spheres remember their velocity, where no theory knows."""

from typing import Any

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.observe import velocity_autocorrelation


class VelocityMemory(velocity_autocorrelation.VelocityMemory):
    """Along the axes without a wall at their ends and without gravity.

    Raises CaseError without such an axis.
    """

    answers = "velocity-autocorrelation"

    def __init__(self, case: Case, observable: Any) -> None:
        shut, pull = closed_axes(case), case.spheres.gravity or (0.0,) * case.box.dimension
        self.axes = tuple(k for k, g in enumerate(pull) if k not in shut and g == 0)
        if not self.axes:
            raise CaseError("velocity-autocorrelation: every axis has gravity or a wall")
