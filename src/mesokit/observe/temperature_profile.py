"""Temperature in slices across an axis, about the mean flow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from mesokit.component import component, tag
from mesokit.observe import setting
from mesokit.observe.estimate import Estimate, of_ratio
from mesokit.observe.profile import Array, Profile, ProfileAccumulator
from mesokit.observe.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case


@component
class TemperatureProfile(Profile):
    """Temperature in slices across an axis: kinetic energy about the mean flow.

    The flow is the mean over the whole run, not that of the few particles in a slice at one
    moment, so that the slices may be as fine as one likes; it must be steady.
    """

    quantity: Literal["temperature-profile"] = tag("temperature-profile")

    def accumulator(self, case: Case) -> TemperatureProfileAccumulator:
        """An empty memory for it."""
        return TemperatureProfileAccumulator(self, case)


class TemperatureProfileAccumulator(ProfileAccumulator):
    """Number, mass, sum of m v^2 and momentum of each slice."""

    def __init__(self, observable: TemperatureProfile, case: Case) -> None:
        super().__init__(observable, case, width=3 + case.box.dimension)

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Number, mass, sum of m v^2, momentum."""
        return np.concatenate([[number, mass, energy], momentum])

    def result(self) -> Result:
        """T = (<E> - 2 u.<P> + u^2 <M>)/(d <N>), u = <P>/<M>, first order exact in u."""
        sums, samples = self.blocks.sums()
        number, mass, energy = sums[:, 0], sums[:, 1], sums[:, 2]
        momentum = sums[:, 3:]
        with np.errstate(divide="ignore", invalid="ignore"):
            flow = momentum.sum(axis=0) / mass.sum(axis=0)
        peculiar = energy - 2 * (flow * momentum).sum(axis=1) + (flow**2).sum(axis=0) * mass
        d = self.case.box.dimension
        temperature = of_ratio(peculiar, d * number)
        expected = self.expected()
        found: list[Comparison] = []
        if expected is not None and self.blocks.count:
            weight = number.sum(axis=0) / number.sum()
            everywhere = of_ratio(peculiar.sum(axis=1), d * number.sum(axis=1))
            mean = float(weight @ expected)
            found.append(
                Comparison(
                    "mean temperature",
                    float(everywhere.value),
                    setting.with_start(self.case, float(everywhere.error), mean),
                    mean,
                    "m a^2/tau^2",
                )
            )
            found += self.chi_square(
                Estimate(temperature.value, temperature.residuals, samples.astype(float)),
                expected,
                "against theory",
            )
        return Result(
            quantity="temperature-profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=temperature.value,
            error=temperature.error,
            label="temperature k_B T",
            units={"value": "m a^2/tau^2", self.observable.axis: "a"},
            expected=expected,
            theory="kT of the case",
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    def expected(self) -> Array | None:
        """kT where something holds it, or where nothing heats or cools the fluid.

        A cell thermostat counts the shear within a cell, m (gdot a)^2/12, as heat: the fluid is
        that much colder. A slice counts the shear within itself.
        """
        fluid, d = self.case.fluid, self.case.box.dimension
        if not setting.isothermal(self.case) and setting.driven(self.case):
            return None
        inside_slice = (self.edges[1] - self.edges[0]) ** 2
        counted = 0.0 if fluid.collision.rule.startswith("at") else 1.0
        shear2 = np.zeros(self.bins)
        for direction in range(d):
            flow = setting.flow(self.case, direction)
            if flow.profile is None:
                return None
            if flow.across == self.axis:
                velocity = flow.profile(self.edges)
                shear2 += (np.diff(velocity) / np.diff(self.edges)) ** 2
            elif flow.kind != "rest":
                return None  # the mean over the slice is not the flow
        return fluid.kT + fluid.mass * shear2 * (inside_slice - counted) / (12 * d)
