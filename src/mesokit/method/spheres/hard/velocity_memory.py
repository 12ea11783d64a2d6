"""What Enskog's theory says of how long hard spheres remember their velocity."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.method.spheres.common.velocity_memory import VelocityMemory
from mesokit.method.spheres.hard.displacement import enskog

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.seam.engine import Array, Integers

COARSE = 0.5  # memories between two samples, beyond which the sum over them is no integral
NOTE = "approximate: Enskog: neglects velocity correlations"


class EnskogMemory(VelocityMemory):
    """exp(-t/T), T = m D/kT, with the D of Enskog. The energy is that of the start, exactly."""

    def __init__(self, case: Case, observable: Any) -> None:
        super().__init__(case, observable)
        self.coefficient, self.time = enskog(case)
        self.timestep = float(case.spheres.timestep)
        # velocities add up to zero, and a component has n - 1 of n degrees of freedom
        self.square = self.coefficient / self.time * (1 - 1 / case.particles)

    def expected(self, steps: Integers) -> Array | None:
        """Of a component; None without a theory."""
        if math.isnan(self.time):
            return None
        return np.asarray(self.square * np.exp(-steps * self.timestep / self.time))

    def legend(self) -> str:
        """Whose law it is."""
        return "Enskog"

    def level(self, error: float, runs: int) -> tuple[float, float] | None:
        """kT/m, which the start gives exactly."""
        return self.square, error

    def share(self, every: int) -> str | None:
        """Not told without a theory."""
        return None if math.isnan(self.time) else NOTE

    def diffusion(self, every: int) -> tuple[float, str] | None:
        """D of Enskog."""
        coarse = every * self.timestep > COARSE * self.time  # nan: not known, and told
        return None if coarse else (self.coefficient, "" if math.isnan(self.time) else NOTE)
