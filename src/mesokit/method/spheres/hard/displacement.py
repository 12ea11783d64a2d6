"""What theory says of how far hard spheres go."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.errors import CaseError
from mesokit.statistics import spread_ids

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.seam.engine import Array, Integers

DECAYED = 5.0  # times of the velocity's memory after which motion is diffusive


class Displacement:
    """Ballistic at first, diffusive when the velocity is forgotten: 2 D (t - T + T exp(-t/T)) along
    each axis, T = m D/kT, with the D of Enskog."""

    answers = "mean-square-displacement"

    def __init__(self, case: Case, observable: Any) -> None:
        if observable.of != "particles" or observable.kind is not None:
            raise CaseError("of: expected 'particles'; there are no molecules")
        chosen = observable.components or [axis for axis in case.box.axes if not _shut(case, axis)]
        if not chosen:
            raise CaseError("mean-square-displacement: every axis is closed by a wall")
        self.axes = tuple(case.box.index(axis, "components") for axis in chosen)
        self.case, self.length, self.number = case, 1, case.particles
        self.timestep = case.spheres.timestep
        self.diffusion, self.memory = enskog(case)

    def beads(self, wanted: int) -> Integers:
        """Numbers (n, 1) of so many spheres, evenly spread."""
        return spread_ids(wanted, self.number)[:, None]

    def expected(self, steps: Integers) -> Array | None:
        """The displacement after so many steps, None without a theory."""
        if not math.isfinite(self.diffusion):
            return None
        time = np.asarray(steps * self.timestep, float)
        flown: NDArray[np.float64] = time + self.memory * np.expm1(-time / self.memory)
        return 2 * len(self.axes) * self.diffusion * flown

    def coefficient(self) -> tuple[float, str]:
        """D of Enskog, which is not exact."""
        return self.diffusion, "approximate: Enskog: neglects velocity correlations"

    def diffusive_from(self) -> float:
        """When the velocity is forgotten."""
        return DECAYED * self.memory if math.isfinite(self.memory) else 0.0

    def grows(self) -> bool:
        """In 2D, where neither walls nor heating take momentum."""
        kept = not (self.case.walls or self.case.spheres.heating)
        return self.case.box.dimension == 2 and kept and self.number > 1

    def level_from(self) -> float:
        """Never: nothing holds them."""
        return math.inf

    def legend(self) -> str:
        """Whose law it is."""
        return "Enskog"


def _shut(case: Case, axis: str) -> bool:
    return any(axis in wall.closed_axes for wall in case.walls)


def enskog(case: Case) -> tuple[float, float]:
    """Diffusion coefficient and memory of the velocity, nan where there is no theory."""
    section, box = case.spheres, case.box
    kind, d = section.kinds[0], box.dimension
    alike = len(section.kinds) == 1 and kind.spread == 0 and case.particles > 1
    quiet = not (case.walls or section.gravity or section.heating) and section.kT > 0
    if not (alike and quiet and section.collision.elastic and section.collision.hard):
        return math.nan, math.nan
    if section.collision.rough:
        return math.nan, math.nan
    kT_over_m = section.kT / kind.mean_mass(d)
    chi = theory.contact_value(section.fraction(box), d)
    density, diameter = case.particles / box.volume, kind.diameter * section.scale(box)
    found = theory.enskog_diffusion(density, diameter, kT_over_m, chi, d)
    return found, found / kT_over_m
