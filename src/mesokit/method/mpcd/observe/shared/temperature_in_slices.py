"""The temperature of an MPCD fluid in slices: that of the thermostat, or the heat of friction."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.heating import settled, temperature_rise
from mesokit.method.mpcd.observe.shared.flow_in_slices import refuse_kinds
from mesokit.observe.shared.profile import Array, Compared, ProfileAccumulator
from mesokit.seam.estimate import Estimate
from mesokit.seam.result import Comparison

CORRELATIONS = 0.02  # largest measured rise for (shear rate)^2 that molecular chaos leaves out
ACCURACY = 6  # per cent of the rise by friction, measured up to Mach number 0.6


class TemperatureInSlices:
    """kT of the case, and what shear adds to it."""

    answers = "temperature-profile"
    ids: NDArray[np.int64] | None = None  # all particles count
    rests = False  # even a fluid at rest is measured about its mean velocity
    fewest = 0

    def __init__(self, case: Case, observable: Any) -> None:
        self.case = case
        refuse_kinds(observable.kind)
        flows = [setting.flow(case, i) for i in range(case.box.dimension)]
        self.flows = [flow for flow in flows if flow.kind != "rest"]
        others = {flow.across for flow in self.flows} - {case.box.index(observable.axis)}
        self.across = min(others) if others else None

    def compared(
        self, profile: ProfileAccumulator, temperature: Estimate, mean: Estimate, number: Array
    ) -> Compared:
        """The temperature (bins,) and its mean over all, by the number (bins,) of sightings."""
        expected, note = self.expected(profile), self.note(profile)
        found: list[Comparison] = []
        if expected is not None and profile.blocks.count:
            weight = number / number.sum()
            known = float(weight @ expected)
            value, error = float(mean.value), float(mean.error)
            error = setting.with_start(self.case, error, known, profile.blocks.series)
            found = [Comparison("mean temperature", value, error, known, "m a^2/tau^2", note)]
            if not note:
                found += profile.chi_square(temperature, expected, "against theory")
        law = "heat of friction" if self.heated else "kT of the case"
        return Compared(expected, law + (", approximate" if note else ""), found)

    def expected(self, profile: ProfileAccumulator) -> Array | None:
        """kT where something holds it, or where nothing heats or cools the fluid.

        What the thermostat of the cells makes of the shear (`theory.shear_warming`) comes on top,
        or the heat that plates without a thermostat have yet to take, and the shear within a slice.
        """
        fluid = self.case.fluid
        if not self.flows:
            return np.full(profile.bins, fluid.kT)
        if any(flow.profile is None for flow in self.flows):
            return None
        inside = fluid.mass / profile.observable.bins_per_cell**2 / (12 * self.case.box.dimension)
        if self.heated:
            rise = self.rise(profile)
            return None if rise is None else fluid.kT + rise + inside * self.shear2(profile)
        warming = setting.warming(self.case)
        return None if warming is None else fluid.kT + (warming + inside) * self.shear2(profile)

    @property
    def heated(self) -> bool:
        """Whether friction heats the fluid, and no thermostat takes that."""
        return bool(self.flows) and not setting.isothermal(self.case)

    def rise(self, profile: ProfileAccumulator) -> Array | None:
        """Of the temperature by friction in each slice of a slit; None until it is steady."""
        (across,) = {flow.across for flow in self.flows}
        found = temperature_rise(self.case) if settled(self.case, across) else None
        if found is None:
            return None
        if profile.axis != across:
            return np.full(profile.bins, found.mean())
        height = np.linspace(0.0, float(self.case.box.size[across]), len(found))
        return setting.bin_average(lambda y: np.interp(y, height, found), profile.edges)

    def shear2(self, profile: ProfileAccumulator) -> Array:
        """Square of the shear rate of the expected flow in each slice, (bins,)."""
        squares = np.zeros(profile.bins)
        for flow in self.flows:
            if flow.profile is None:
                continue
            length = float(self.case.box.size[flow.across])
            bins = int(length) * profile.observable.bins_per_cell
            edges = np.linspace(0.0, length, bins + 1)
            rates = np.diff(flow.profile(edges)) / np.diff(edges)
            squares += rates**2 if flow.across == profile.axis else np.mean(rates**2)
        return squares

    def note(self, profile: ProfileAccumulator) -> str:
        """Effects missing from the expected temperature, if they are above 0.01 %."""
        if self.heated:
            return f"approximate: molecular chaos, within some {ACCURACY:g} % of the rise"
        missing = CORRELATIONS * self.case.fluid.mass * float(np.mean(self.shear2(profile)))
        if missing > 1e-4 * self.case.fluid.kT:
            percent = 100 * missing / self.case.fluid.kT
            return f"approximate: correlated collisions under shear add up to {percent:.2g} %"
        return setting.temperature_note(self.case)
