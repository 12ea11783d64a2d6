"""How the velocities of a fluid are distributed."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.seam.engine import RunningFluid
from mesokit.statistics import spread_ids

Array = NDArray[np.float64]


class Velocities:
    """Maxwell's distribution at kT, where the fluid is at rest.

    Where the total momentum is zero, a component loses what the mean of its numbers would take. A
    fluid that keeps its energy does so for each run alone: over many starts nothing is lost.
    """

    answers = "velocity-distribution"

    def __init__(self, case: Case, observable: Any) -> None:
        if observable.kind is not None:
            raise CaseError(f"kind = {show(observable.kind)}: of spheres alone")
        self.case, d = case, case.box.dimension
        still = [k for k in range(d) if setting.flow(case, k).kind == "rest"]
        given = observable.component
        self.axis = AXES.index(given) if given else still[0] if still else 0
        self.ids = spread_ids(observable.particles, case.particles)
        self.driven, self.isothermal = setting.driven(case), setting.isothermal(case)
        thermal = setting.at_kT(case)
        self.known = thermal and self.axis in still, thermal and len(still) == d
        closed, part = not (case.walls or self.driven), len(self.ids) / case.particles
        # how far particles that differ in mass are one kind where momentum is shared
        fluid = case.fluid
        masses = np.array([kind.mass for kind in fluid.kinds])
        weights = np.array([kind.density for kind in fluid.kinds])
        alike = (weights @ np.sqrt(masses)) ** 2 / (weights.sum() * (weights @ masses))
        alike = float(alike * fluid.density * fluid.mass / setting.mass_density(case))
        self.taken_by_mean = part * alike if closed else 0.0
        self.taken_by_energy = 0.0
        self.kept_energy = part if closed and not self.isothermal else 0.0
        self.cumulant = 0.0

    def numbers(self, fluid: RunningFluid) -> Array:
        """Velocities (n, d) over sqrt(kT/m)."""
        scale = np.sqrt(fluid.masses(self.ids) / self.case.fluid.kT)
        return np.asarray(fluid.velocities(self.ids) * scale[:, None])

    def warm(self, runs: int) -> float:
        """By how much kT may be off for good, relative, over so many runs."""
        if self.kept_energy == 0.0:
            return 0.0
        return float(np.sqrt(2.0 / (self.case.box.dimension * self.case.particles * runs)))

    def legend(self) -> str:
        """Whose law it is."""
        return "Maxwell"

    def note(self, classes: int) -> str:
        """Note on the theory."""
        if self.driven:
            return "approximate: Maxwell about a mean flow"
        return setting.temperature_note(self.case) or f"Maxwell, {classes} classes"
