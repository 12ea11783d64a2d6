"""Velocity autocorrelation of particles."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, option, param, tag
from mesokit.observe.shared.of_method import OfMethod
from mesokit.observe.shared.origins import Origins
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import spread_ids

Integers = NDArray[np.int64]


class VelocityMemory(Protocol):
    """Theory of the autocorrelation of velocities by a method.

    It is made of a case and the observable, and raises CaseError where there is nothing to follow.
    `axes` are those that count. What is not overridden holds for particles without a theory.
    """

    axes: tuple[int, ...]

    def expected(self, steps: Integers) -> Array | None:
        """The autocorrelation of a component after so many steps; None without a theory."""
        return None

    def legend(self) -> str:
        """Name of the theory in a figure."""
        return ""

    def level(self, error: float, runs: int) -> tuple[float, float] | None:
        """The value at lag 0, nan if it is not known, and the error of the measured one over so
        many runs with what their starts add to it; None if it is not given."""
        return math.nan, error

    def with_start(self, error: float, value: float, runs: int) -> float:
        """The error of a number that grows as kT, with what the starts of so many runs add."""
        return error

    def share(self, every: int) -> str | None:
        """Note on the share that is left after a lag; None if that is not reported."""
        return None

    def diffusion(self, every: int) -> tuple[float, str] | None:
        """The diffusion coefficient that the integral is, and what to say of it; None if it is
        not given."""
        return math.nan, ""

    def tail(self, time: Array) -> Array | None:
        """A hydrodynamic tail, nan where it does not hold; None without one."""
        return None

    def crossing(self) -> float:
        """The time until which the tail holds."""
        return math.inf


@component
class VelocityAutocorrelation(OfMethod):
    """Mean product of a particle's velocity at two times, one component: kT/m at lag 0.

    Axes along which the fluid flows or that a wall closes are left out. The integral is a diffusion
    coefficient.
    """

    quantity: Literal["velocity-autocorrelation"] = tag("velocity-autocorrelation")
    drawing, value_label = "memory", "velocity autocorrelation"
    units: ClassVar[dict[str, str]] = {"value": "a^2/tau^2", "time": "tau"}
    asks_transport: ClassVar[bool] = True
    in_open_box: ClassVar[bool] = True
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)
    particles: int = param(2000, doc="particles followed", ge=1)
    max_lag: int = param(200, doc="longest lag", unit="steps", ge=1)


@accumulator_of(VelocityAutocorrelation)
class VelocityAutocorrelationAccumulator(BlockAccumulator):
    """Velocities at many origins."""

    memory: ClassVar[tuple[str, ...]] = ("origins",)

    def prepare(self) -> None:
        observable, self.timestep = self.observable, method_of(self.case).timestep(self.case)
        self.theory: VelocityMemory = observable.theory(self.case)
        self.axes = list(self.theory.axes)
        self.ids = spread_ids(observable.particles, self.case.particles)
        max_lag = max(1, observable.max_lag // observable.every)
        self.origins = Origins(len(self.ids), len(self.axes), max_lag)

    def observe(self, fluid: RunningFluid) -> None:
        velocity = fluid.velocities(self.ids)[:, self.axes]
        self.origins.add(velocity, lambda old, new: np.einsum("ij,ij->i", old, new))

    def result(self) -> Result:
        """The curve with molecular chaos and the hydrodynamic tail."""
        kept = self.origins.estimate().divided(len(self.axes))
        steps = self.origins.sampled() * self.observable.every
        time = steps * self.timestep
        expected, tail = self.theory.expected(steps), self.theory.tail(time)
        return self.report(
            {"time": time},
            kept,
            self.comparisons(time, kept, expected, tail),
            expected=expected,
            theory=self.theory.legend(),
            samples=self.origins.count,
            extra={} if tail is None else {"tail": tail},
        )

    def comparisons(
        self, time: Array, kept: Estimate, expected: Array | None, tail: Array | None
    ) -> Iterator[Comparison]:
        """Equipartition, what the first collisions leave, the diffusion coefficient, the tail."""
        n, every, runs = len(time), self.observable.every, self.origins.series
        if not n:
            return
        first = np.eye(n)[0]
        value, error = kept.scalar(kept.value[0], first)
        if (level := self.theory.level(error, runs)) is not None:
            known, error = level
            yield Comparison("value at lag 0", value, error, known, "a^2/tau^2")
        if n < 3:
            return
        if (note := self.theory.share(every)) is not None and expected is not None:
            share = kept.value[1] / kept.value[0]
            gradient = (np.eye(n)[1] - share * first) / kept.value[0]
            what, known = f"share left after {time[1]:g} tau", float(expected[1] / expected[0])
            yield Comparison(what, *kept.scalar(share, gradient), known, "", note)
        if (diffusion := self.theory.diffusion(every)) is not None:
            trapezoid = np.zeros(n)
            trapezoid[1:] += np.diff(time) / 2
            trapezoid[:-1] += np.diff(time) / 2
            value, error = kept.total(trapezoid)
            error = self.theory.with_start(error, value, runs)
            what = f"diffusion coefficient up to {time[-1]:g} tau"
            yield Comparison(what, value, error, diffusion[0], "a^2/tau", diffusion[1])
        if tail is not None:
            window = np.isfinite(tail) & (time <= self.theory.crossing())
            if window.sum() >= 3:
                weight = np.where(window, tail, 0.0)  # as the noise is the same everywhere
                weight /= (weight**2).sum()
                yield Comparison("ratio to the hydrodynamic tail", *kept.total(weight), 1.0)
