"""Relaxation modulus from the fluctuations of the stress at rest, and the moduli that follow."""

import math
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, option, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.rheometer import modes_of_stress, shear_note
from mesokit.method.mpcd.observe.shared.decay import averaged
from mesokit.method.mpcd.observe.stress import UNIT
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import MultipleTau

NOISE = 1.0  # standard errors: the integral ends where G first falls below so many
ROUGH = 0.2  # relative error that hides by how much a theory is approximate
STRESS_TIMES = 4.0  # to which it goes where molecules relax as in theory: all but 2 %
FREQUENCIES = 40


@component
class StressAutocorrelation(Observable):
    """G(t) = V/kT <s(t) s(0)> of the shear stresses s of a fluid at rest (Green and Kubo).

    Its integral is the viscosity; half of the value at lag 0 counts, as time is discrete. It ends
    after four stress times of molecules, or, where these are not known, where G is lost in noise.
    """

    quantity: Literal["stress-autocorrelation"] = tag("stress-autocorrelation")
    measures: ClassVar[tuple[str, ...]] = ("stress",)
    drawing = "modulus"
    value_label = "relaxation modulus G"
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)
    max_lag: int | None = param(
        None, doc="longest lag (as the run allows unless said)", unit="steps", ge=1
    )

    def check(self, case: Case) -> None:
        """Raise CaseError where the fluid is not at rest or has walls."""
        if case.walls:
            raise CaseError("stress is measured without walls")
        if setting.driven(case):
            raise CaseError("stress-autocorrelation: only of a fluid at rest")


@accumulator_of(StressAutocorrelation)
class StressAutocorrelationAccumulator(BlockAccumulator):
    """A correlator of the elements off the diagonal."""

    memory: ClassVar[tuple[str, ...]] = ("correlator",)
    added: ClassVar[tuple[str, ...]] = ("runs",)

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        max_lag = None if observable.max_lag is None else observable.max_lag // observable.every
        d = case.box.dimension
        self.correlator = MultipleTau((d * (d - 1),), max_lag=max_lag, pooled=1)
        self.runs = 1  # that were pooled

    def observe(self, fluid: RunningFluid) -> None:
        # rules that do not conserve angular momentum have no symmetric stress
        stress = np.sum(list(fluid.stress.values()), axis=0)
        self.correlator.add(stress[~np.eye(len(stress), dtype=bool)])

    def modulus(self) -> tuple[Array, Estimate]:
        """Time (n,) and G(t) with what each block of time adds to it."""
        case = self.case
        lags, found = averaged(self.correlator, case.box.volume / case.fluid.kT)
        return lags * self.observable.every * case.fluid.timestep, found

    def result(self) -> Result:
        time, modulus = self.modulus()
        known = modes_of_stress(self.case)
        bonds = None
        if known is not None and known[1] and len(time):
            bonds = theory.relaxation_modulus(time, *known[:2])
            bonds[time == 0] = np.nan  # where all collide as well
        found, extra = self.integrals(time, modulus) if len(time) > 3 else ([], {})
        return self.report(
            {"time": time},
            modulus,
            found,
            units={"value": UNIT[self.case.box.dimension], "time": "tau"},
            expected=bonds,
            theory="Rouse, bonds alone",
            samples=self.correlator.count,
            extra=extra,
        )

    def has_memory(self) -> bool:
        """Whether the stress lasts longer than collisions make it: in molecules and solutes."""
        return self.case.fluid.molecule is not None or self.case.solutes is not None

    def stress_time(self) -> float:
        """The longest of the molecules, nan where it is not known."""
        known = modes_of_stress(self.case)
        return max(known[1], default=np.nan) if known else np.nan

    def end(self, time: Array, modulus: Estimate) -> int:
        """The first lag that the integral leaves out."""
        slow = self.stress_time()
        if slow == slow:
            return max(2, int(np.searchsorted(time, STRESS_TIMES * slow, "right")))
        quiet = np.flatnonzero(~(modulus.value > NOISE * modulus.error))
        return int(quiet[0]) if len(quiet) else len(time)

    def note(self, last: float, error: float) -> str:
        """End of the integral, what that leaves out, and how good the theory is.

        `error`: relative to theory; a large one says nothing about the theory.
        """
        if not self.has_memory():
            return setting.caveat(self.case)
        slow, until = self.stress_time(), f"integral to t = {last:.3g} tau"
        if np.isnan(slow):
            return f"lower bound: {until}, where G is lost in noise"
        length = self.correlator.count / self.runs * self.observable.every
        times = length * self.case.fluid.timestep / slow
        if last < 0.75 * STRESS_TIMES * slow:
            until = f"lower bound: {until}, stress time {slow:.3g} tau"
        elif times < ENOUGH:
            until += f", {of_relaxations(times, self.runs, 'stress times')}"
        return until if error > ROUGH else f"{shear_note(self.case)}; {until}"

    def integrals(self, time: Array, modulus: Estimate) -> tuple[list[Comparison], dict[str, Any]]:
        """Viscosity, and moduli G' = w int G sin wt dt, G'' = w int G cos wt dt with errors."""
        end = self.end(time, modulus)
        # Trapezoids up to the last lag; where noise sets the end, down to zero at the lag beyond.
        stop = min(max(end + bool(np.isnan(self.stress_time())), 2), len(time))
        weight, widths = np.zeros(len(time)), np.diff(time[:stop])
        weight[: len(widths)] += widths / 2
        weight[1:end] += widths[: end - 1] / 2
        density = setting.mass_density(self.case)
        value, spread = modulus.total(weight)
        if not self.has_memory() and (gas := setting.transport(self.case)) is not None:
            kinetic = gas.viscosity_kinetic * density  # which grows as kT
            spread = setting.with_start(self.case, spread, kinetic, self.runs)
        known = modes_of_stress(self.case)
        last = time[stop - 1]
        expected = np.nan
        if known is not None:  # the integral to the same time
            bonds = sum(known[0] * tau * -math.expm1(-last / tau) for tau in known[1])
            expected = (known[2] + bonds) / density
        value, spread, what = value / density, spread / density, "viscosity from the integral"
        note = self.note(last, spread / expected)
        found = [Comparison(what, value, spread, expected, "a^2/tau", note)]
        longest = last if self.has_memory() else time[-1]
        if longest < 2 * time[1]:
            return found, {}
        frequency = np.geomspace(1 / longest, 1 / time[1], FREQUENCIES)
        extra: dict[str, Any] = {"frequency": frequency}
        for name, wave in (("storage", np.sin), ("loss", np.cos)):
            kernel = frequency[:, None] * wave(frequency[:, None] * time) * weight
            transformed = modulus.linear(kernel)
            extra[name], extra[f"{name}_error"] = transformed.value, transformed.error
        if known is not None:
            phi_kT, times, viscosity = known
            extra["storage_theory"] = theory.storage_modulus(frequency, phi_kT, times)
            extra["loss_theory"] = theory.loss_modulus(frequency, phi_kT, times, viscosity)
        return found, extra
