"""Temperature in slices across an axis, about the mean flow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.heating import settled, temperature_rise
from mesokit.observe.shared.profile import (
    Array,
    Profile,
    ProfileAccumulator,
    expected_in_slices,
    part_of,
)
from mesokit.observe.shared.whose import KIND, ids_of_kind
from mesokit.seam.estimate import Estimate, of_ratio
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case

CORRELATIONS = 0.02  # largest measured rise for (shear rate)^2 that molecular chaos leaves out
FEW = 20  # sightings of spheres in a slice that tell no temperature
KEPT = 1e-9  # relative error below which there is none but rounding
ACCURACY = 6  # per cent of the rise by friction, measured up to Mach number 0.6


@component
class TemperatureProfile(Profile):
    """Temperature in slices across an axis: kinetic energy about the mean flow.

    The flow is the mean over the whole run, not that of the few particles in a slice at one
    moment, so that the slices may be as fine as one likes; it must be steady. A flow that varies
    across another axis is resolved in slices across that axis, too. Spheres in equilibrium are as
    warm everywhere.
    """

    quantity: Literal["temperature-profile"] = tag("temperature-profile")
    kind: int | str | None = param(None, doc=KIND)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and a kind that there is not."""
        super(TemperatureProfile, self).check(case)  # noqa: UP008  # the decorator makes a new class
        ids_of_kind(case, self.kind)

    def accumulator(self, case: Case) -> TemperatureProfileAccumulator:
        """An empty memory for it."""
        return TemperatureProfileAccumulator(self, case)


class TemperatureProfileAccumulator(ProfileAccumulator):
    """Number, mass, sum of m v^2 and momentum, (3 + d, bins, bins across the flow).

    There is one bin across the flow if nothing flows, or if it varies across the profile's axis.
    """

    def __init__(self, observable: TemperatureProfile, case: Case) -> None:
        width, self.dimension = 3 + case.box.dimension, case.box.dimension
        super().__init__(observable, case, width)
        self.ids, self.known = (
            ids_of_kind(case, observable.kind),
            expected_in_slices(case, observable),
        )
        of_fluid = self.known is None
        flows = [setting.flow(case, i) for i in range(self.dimension) if of_fluid]
        self.flows = [flow for flow in flows if flow.kind != "rest"]
        others = {flow.across for flow in self.flows} - {self.axis}
        self.across = min(others) if others else None
        if self.across is not None:
            self.axes += (self.across,)
            self.counts += (max(1, round(case.box.size[self.across] * observable.bins_per_cell)),)
        self.blocks = Blocks((width, *self.counts))

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Number, mass, sum of m v^2 and momentum."""
        return np.concatenate([[number, mass, energy], momentum])

    def about_flow(self) -> tuple[Array, Array, NDArray[np.int64]]:
        """Sum of m (v - u)^2 and number (blocks, bins), samples (blocks,)."""
        sums, samples = self.blocks.sums()
        sums = sums.reshape(len(sums), 3 + self.dimension, self.bins, *(self.counts[1:] or (1,)))
        number, mass, energy, momentum = sums[:, 0], sums[:, 1], sums[:, 2], sums[:, 3:]
        # u is the same in all slices along which the flow does not vary
        alike = (0,) if self.across is None else (0, 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = np.stack([momentum[:, i].sum(alike) for i in range(self.dimension)])
            u = np.nan_to_num(u / mass.sum(alike)).reshape(self.dimension, 1, -1, number.shape[2])
        if self.known is not None and self.known.rests:
            u = np.zeros_like(u)
        moving = energy.copy()
        for i in range(self.dimension):
            moving += u[i] * (u[i] * mass - 2 * momentum[:, i])
        return moving.sum(axis=2), number.sum(axis=2), samples

    def result(self) -> Result:
        """T = <m (v - u)^2>/(d <N>), first order exact in u = <P>/<M>."""
        peculiar, number, samples = self.about_flow()
        temperature = of_ratio(peculiar, self.dimension * number)
        everywhere = of_ratio(peculiar.sum(axis=1), self.dimension * number.sum(axis=1))
        found: list[Comparison] = []
        if self.known is not None:
            expected, found = self.of_spheres(temperature, everywhere, samples)
            law, note = "the same everywhere", ""
        else:
            expected, note = self.expected(), self.note()
            law = "heat of friction" if self.heated else "kT of the case"
        if self.known is None and expected is not None and self.blocks.count:
            weight = number.sum(axis=0) / number.sum()
            mean = float(weight @ expected)
            found.append(
                Comparison(
                    "mean temperature",
                    float(everywhere.value),
                    setting.with_start(
                        self.case, float(everywhere.error), mean, self.blocks.series
                    ),
                    mean,
                    "m a^2/tau^2",
                    note,
                )
            )
            if not note:
                found += self.chi_square(
                    Estimate(temperature.value, temperature.residuals, samples.astype(float)),
                    expected,
                    "against theory",
                )
        # about their own mean few spheres are colder than they are
        few = (self.known is not None) & (number.sum(axis=0) < FEW)
        return Result(
            quantity="temperature-profile",
            drawing="profile",
            name=self.name,
            x={self.observable.axis: self.centres},
            value=np.where(few, np.nan, temperature.value),
            error=np.where(few, np.nan, temperature.error),
            label="temperature k_B T",
            units={"value": "m a^2/tau^2", self.observable.axis: "a"},
            expected=expected,
            theory=law + (", approximate" if note else ""),
            comparisons=tuple(found),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    def of_spheres(
        self, temperature: Estimate, everywhere: Estimate, samples: NDArray[np.int64]
    ) -> tuple[Array | None, list[Comparison]]:
        """What theory expects of spheres, the mean temperature, and the profile as a whole."""
        mean, unit = float(everywhere.value), "m a^2/tau^2"
        level, known = self.known.expected(mean)
        told = level if known else np.nan
        error = float(everywhere.error)
        error = 0.0 if error < KEPT * mean else error  # collisions keep it
        found = [Comparison("mean temperature", mean, error, told, unit)]
        if np.isnan(level):
            return None, found if self.blocks.count else []
        inside = self.known.inside(self.edges)
        every = Estimate(temperature.value, temperature.residuals, samples.astype(float))
        expected = np.full(self.bins, level)
        found += self.chi_square(part_of(every, inside), expected[inside], "against theory")
        return expected, found if self.blocks.count else []

    def expected(self) -> Array | None:
        """kT where something holds it, or where nothing heats or cools the fluid.

        What the thermostat of the cells makes of the shear (`theory.shear_warming`) comes on top,
        or the heat that plates without a thermostat have yet to take, and the shear within a slice.
        """
        fluid = self.case.fluid
        if not self.flows:
            return np.full(self.bins, fluid.kT)
        if any(flow.profile is None for flow in self.flows):
            return None
        inside = fluid.mass / self.observable.bins_per_cell**2 / (12 * self.dimension)
        if self.heated:
            rise = self.rise()
            return None if rise is None else fluid.kT + rise + inside * self.shear2()
        warming = setting.warming(self.case)
        return None if warming is None else fluid.kT + (warming + inside) * self.shear2()

    @property
    def heated(self) -> bool:
        """Whether friction heats the fluid, and no thermostat takes that."""
        return bool(self.flows) and not setting.isothermal(self.case)

    def rise(self) -> Array | None:
        """Of the temperature by friction in each slice of a slit; None until it is steady."""
        (across,) = {flow.across for flow in self.flows}
        found = temperature_rise(self.case) if settled(self.case, across) else None
        if found is None:
            return None
        if self.axis != across:
            return np.full(self.bins, found.mean())
        height = np.linspace(0.0, float(self.case.box.size[across]), len(found))
        return setting.bin_average(lambda y: np.interp(y, height, found), self.edges)

    def shear2(self) -> Array:
        """Square of the shear rate of the expected flow in each slice, (bins,)."""
        squares = np.zeros(self.bins)
        for flow in self.flows:
            if flow.profile is None:
                continue
            length = float(self.case.box.size[flow.across])
            bins = int(length) * self.observable.bins_per_cell
            edges = np.linspace(0.0, length, bins + 1)
            rates = np.diff(flow.profile(edges)) / np.diff(edges)
            squares += rates**2 if flow.across == self.axis else np.mean(rates**2)
        return squares

    def note(self) -> str:
        """What is known to be missing from the expected temperature, if it is above 0.01 %."""
        if self.heated:
            return f"approximate: molecular chaos, within some {ACCURACY:g} % of the rise"
        missing = CORRELATIONS * self.case.fluid.mass * float(np.mean(self.shear2()))
        if missing > 1e-4 * self.case.fluid.kT:
            percent = 100 * missing / self.case.fluid.kT
            return f"approximate: correlated collisions under shear add up to {percent:.2g} %"
        return setting.temperature_note(self.case)
