"""Velocity autocorrelation by molecular chaos and hydrodynamics."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import self_diffusion

Array = NDArray[np.floating[Any]]
Integers = NDArray[np.int64]


class VelocityMemory:
    """Of particles of the fluid, along the axes without a flow or a wall.

    Raises CaseError without such an axis.
    """

    answers = "velocity-autocorrelation"

    def __init__(self, case: Case, observable: Any) -> None:
        self.case, self.axes = case, tuple(setting.quiet_axes(case))
        if not self.axes:
            raise CaseError("velocity-autocorrelation: every axis has a flow or a wall")
        self.coefficients = setting.transport(case)

    def expected(self, steps: Integers) -> Array | None:
        """Molecular chaos; kT/m for ever where particles fly freely."""
        fluid = self.case.fluid
        if self.coefficients is not None:
            g = theory.decorrelation_from_diffusion(
                self.coefficients.diffusion, fluid.timestep, fluid.kT, fluid.mass
            )
            return np.asarray(theory.vacf_molecular_chaos(steps, g, fluid.kT, fluid.mass))
        case = self.case
        bound = case.walls or fluid.molecule is not None or fluid.mixed
        if not (fluid.collision.acts or bound or fluid.force.acts):  # velocities never change
            return np.full(len(steps), fluid.kT / fluid.mass)
        return None

    def legend(self) -> str:
        """Whose law it is."""
        chaos = self.case.fluid.collision.acts
        return setting.chaos_label(self.case) if chaos else "free flight"

    def level(self, error: float, runs: int) -> tuple[float, float] | None:
        """kT/m, and the error of the value at lag 0 with what a start adds to it; None of
        mixtures."""
        fluid = self.case.fluid
        if fluid.mixed:
            return None
        known = fluid.kT / fluid.mass
        return known, setting.with_start(self.case, error, known, runs)

    def with_start(self, error: float, value: float, runs: int) -> float:
        """The error of a number that grows as kT, with what the starts of so many runs add."""
        return setting.with_start(self.case, error, value, runs)

    def share(self, every: int) -> str | None:
        """Note on the share that is left after a lag; None without a theory."""
        if self.coefficients is None:
            return None
        # particles of a fluid at rest have not met before their first collision: it is exact
        return "" if every == 1 else setting.chaos(self.case, "memory lasts longer")

    def diffusion(self, every: int) -> tuple[float, str] | None:
        """The diffusion coefficient that is the integral, and its note; None without a theory."""
        if self.coefficients is None or every > 1:  # else the sum over steps is not known
            return None
        return self_diffusion(self.case)

    def tail(self, time: Array) -> Array | None:
        """The hydrodynamic tail in this box once sound has left the cell, nan before."""
        if self.coefficients is None:
            return None
        found, fluid = np.full(len(time), np.nan), self.case.fluid
        late = time >= 5 / self.coefficients.sound_speed
        nu, diffusion = self.coefficients.viscosity, self.coefficients.diffusion
        if late.any() and not self.case.walls:
            size = np.array(self.case.box.size, float)
            found[late] = theory.vacf_modes(
                time[late], nu, diffusion, fluid.density, size, fluid.kT, fluid.mass
            )
        return found

    def crossing(self) -> float:
        """When the slowest shear wave of the box has decayed, and the tail with it."""
        assert self.coefficients is not None
        return max(self.case.box.size) ** 2 / (4 * np.pi**2 * self.coefficients.viscosity)
