"""Displacement and velocity memory of spheres, without a theory."""

from typing import Any

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.observe import mean_square_displacement, velocity_autocorrelation
from mesokit.seam.method import method_of


class SphereDisplacement(mean_square_displacement.Displacement):
    """Displacement along the chosen axes, or those without a wall at their ends.

    Raises CaseError without such an axis.
    """

    answers = "mean-square-displacement"

    def __init__(self, case: Case, observable: Any) -> None:
        if observable.of != "particles" or observable.kind is not None:
            raise CaseError("of: expected 'particles'; there are no molecules")
        shut = closed_axes(case)
        free = [axis for k, axis in enumerate(case.box.axes) if k not in shut]
        chosen = observable.components or free
        if not chosen:
            raise CaseError("mean-square-displacement: every axis is closed by a wall")
        self.axes = tuple(case.box.index(axis, "components") for axis in chosen)
        self.case, self.length, self.number = case, 1, case.particles
        self.timestep = method_of(case).timestep(case)

    def _keeps_momentum(self) -> bool:
        """Whether neither walls nor anything else takes momentum of all spheres."""
        return not self.case.walls

    def grows(self) -> bool:
        """Whether D grows with the lag: in 2D where momentum is kept."""
        return self.case.box.dimension == 2 and self._keeps_momentum() and self.number > 1


class VelocityMemory(velocity_autocorrelation.VelocityMemory):
    """Memory along the axes without a wall at their ends and without gravity.

    Raises CaseError without such an axis.
    """

    answers = "velocity-autocorrelation"

    def __init__(self, case: Case, observable: Any) -> None:
        shut, pull = closed_axes(case), case.spheres.gravity or (0.0,) * case.box.dimension
        self.axes = tuple(k for k, g in enumerate(pull) if k not in shut and g == 0)
        if not self.axes:
            raise CaseError("velocity-autocorrelation: every axis has gravity or a wall")
