"""Number of particles per cell in slices across an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from mesokit.component import component, tag
from mesokit.observe import setting
from mesokit.observe.estimate import Estimate, of_mean
from mesokit.observe.profile import Array, Profile, ProfileAccumulator
from mesokit.observe.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case


@component
class DensityProfile(Profile):
    """Particles per cell in slices across an axis; uniform but for a force towards a plate."""

    quantity: Literal["density-profile"] = tag("density-profile")

    def accumulator(self, case: Case) -> DensityProfileAccumulator:
        """An empty memory for it."""
        return DensityProfileAccumulator(self, case)


class DensityProfileAccumulator(ProfileAccumulator):
    """Density of each slice."""

    def __init__(self, observable: DensityProfile, case: Case) -> None:
        super().__init__(observable, case, width=1)
        size = case.box.size
        self.slice_volume = np.prod(size) / self.bins

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Particles per volume."""
        return number[None] / self.slice_volume

    def result(self) -> Result:
        """The profile, compared as a whole and next to each plate."""
        every = of_mean(self.blocks)
        density = Estimate(every.value[0], every.residuals[:, 0], every.weights)
        expected = self.expected()
        found: list[Comparison] = []
        if expected is not None and self.blocks.count:
            found = self.chi_square(density, expected, "against theory")
            if not self.periodic:
                cell = self.observable.bins_per_cell
                for name, part in (("lower", slice(0, cell)), ("upper", slice(-cell, None))):
                    mean = np.zeros(self.bins)
                    mean[part] = 1 / cell
                    value, error = density.scalar(mean @ density.value, mean)
                    where = f"density in the cell at the {name} plate"
                    found.append(Comparison(where, value, error, float(mean @ expected), "1/cell"))
        return Result(
            quantity="density-profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=density.value,
            error=density.error,
            label="density",
            units={"value": "1/cell", self.observable.axis: "a"},
            expected=expected,
            theory="ideal gas",
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    def expected(self) -> Array | None:
        """Uniform; barometric under a force towards a plate; None for a mixture under one."""
        density, height = self.case.fluid.density, self.edges[-1]
        weight = setting.acceleration(self.case)[self.axis]
        if self.periodic or weight == 0:
            return np.full(self.bins, density)
        if len({kind.mass for kind in self.case.fluid.species}) > 1:
            return None
        decay = self.case.fluid.mass * weight / self.case.fluid.kT
        scale = density * height * decay / np.expm1(decay * height)
        return scale * setting.bin_average(lambda y: np.exp(decay * y), self.edges)
