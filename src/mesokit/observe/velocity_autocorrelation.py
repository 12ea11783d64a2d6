"""Velocity autocorrelation of fluid particles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.component import component, option, param, tag
from mesokit.engine import RunningFluid
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import self_diffusion
from mesokit.observe.shared.estimate import Estimate
from mesokit.observe.shared.origins import Origins
from mesokit.observe.shared.protocol import Observable, State, pack, unpack
from mesokit.observe.shared.result import Array, Comparison, Result
from mesokit.statistics import spread_ids

if TYPE_CHECKING:
    from mesokit.case.case import Case


@component
class VelocityAutocorrelation(Observable):
    """Mean product of a particle's velocity at two times, one component: kT/m at lag 0.

    Axes along which the fluid flows or that a wall closes are left out.
    """

    quantity: Literal["velocity-autocorrelation"] = tag("velocity-autocorrelation")
    asks_transport: ClassVar[bool] = True
    in_open_box: ClassVar[bool] = True
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)
    particles: int = param(2000, doc="particles followed", ge=1)
    max_lag: int = param(200, doc="longest lag", unit="steps", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without an axis to follow."""
        if not setting.quiet_axes(case):
            raise CaseError("velocity-autocorrelation: every axis has a flow or a wall")

    def accumulator(self, case: Case) -> VelocityAutocorrelationAccumulator:
        """An empty memory for it."""
        return VelocityAutocorrelationAccumulator(self, case)


class VelocityAutocorrelationAccumulator:
    """Velocities at many origins."""

    def __init__(self, observable: VelocityAutocorrelation, case: Case) -> None:
        observable.check(case)
        self.observable, self.case, self.name = observable, case, observable.label
        self.axes = list(setting.quiet_axes(case))
        self.ids = spread_ids(observable.particles, case.particles)
        max_lag = max(1, observable.max_lag // observable.every)
        self.origins = Origins(len(self.ids), len(self.axes), max_lag)

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        velocity = fluid.velocities(self.ids)[:, self.axes]
        self.origins.add(velocity, lambda old, new: np.einsum("ij,ij->i", old, new))

    def state(self) -> State:
        """All it has to remember."""
        return pack(origins=self.origins)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.origins.restore(unpack(state, "origins"))

    def pool(self, other: VelocityAutocorrelationAccumulator) -> None:
        """Take in the samples of an independent run of the same case: only to read."""
        self.origins.pool(other.origins)

    def result(self) -> Result:
        """The curve with molecular chaos and the hydrodynamic tail."""
        total, axes = self.origins.estimate(), len(self.axes)
        kept = Estimate(total.value / axes, total.residuals / axes, total.weights)
        steps = self.origins.sampled() * self.observable.every
        time = steps * self.case.fluid.timestep
        fluid, coefficients = self.case.fluid, setting.transport(self.case)
        expected, extra = None, {}
        if coefficients is not None:
            g = theory.decorrelation_from_diffusion(
                coefficients.diffusion, fluid.timestep, fluid.kT, fluid.mass
            )
            expected = theory.vacf_molecular_chaos(steps, g, fluid.kT, fluid.mass)
            extra["tail"] = self.tail(time, coefficients)
        elif self._keep_velocities():
            expected = np.full(len(time), fluid.kT / fluid.mass)
        return Result(
            quantity="velocity-autocorrelation",
            drawing="memory",
            name=self.name,
            x={"time": time},
            value=kept.value,
            error=kept.error,
            label="velocity autocorrelation",
            units={"value": "a^2/tau^2", "time": "tau"},
            expected=expected,
            theory=setting.chaos_label(self.case) if fluid.collision.acts else "free flight",
            comparisons=tuple(self.comparisons(time, kept, expected, coefficients, extra)),
            samples=self.origins.count,
            extra=extra,
        )

    def _keep_velocities(self) -> bool:
        """Whether particles fly freely, and so for ever as they started."""
        case = self.case
        bound = case.walls or case.fluid.molecule is not None or case.fluid.mixed
        return not (case.fluid.collision.acts or bound or case.fluid.force.acts)

    def tail(self, time: Array, coefficients: theory.Transport) -> Array:
        """The hydrodynamic tail in this box once sound has left the cell, nan before."""
        tail, fluid = np.full(len(time), np.nan), self.case.fluid
        late = time >= 5 / coefficients.sound_speed
        nu, diffusion = coefficients.viscosity, coefficients.diffusion
        if late.any() and not self.case.walls:
            size = np.array(self.case.box.size, float)
            tail[late] = theory.vacf_modes(
                time[late], nu, diffusion, fluid.density, size, fluid.kT, fluid.mass
            )
        return tail

    def comparisons(
        self,
        time: Array,
        kept: Estimate,
        expected: Array | None,
        coefficients: theory.Transport | None,
        extra: Mapping[str, Array],
    ) -> list[Comparison]:
        """Equipartition, what the first collisions leave, the diffusion coefficient, the tail."""
        if not len(time):
            return []
        fluid, n = self.case.fluid, len(time)
        first = np.eye(n)[0]
        value, error = kept.scalar(kept.value[0], first)
        found = []
        if not fluid.mixed:
            equipartition = fluid.kT / fluid.mass
            error = setting.with_start(self.case, error, equipartition, self.origins.series)
            found.append(Comparison("value at lag 0", value, error, equipartition, "a^2/tau^2"))
        if coefficients is None or expected is None or n < 3:
            return found
        share = kept.value[1] / kept.value[0]
        gradient = (np.eye(n)[1] - share * first) / kept.value[0]
        value, error = kept.scalar(share, gradient)
        what = f"share left after {time[1]:g} tau"
        # particles of a fluid at rest have not met before their first collision: it is exact
        note = "" if self.observable.every == 1 else setting.chaos(self.case, "memory lasts longer")
        found.append(Comparison(what, value, error, float(expected[1] / expected[0]), "", note))
        if self.observable.every == 1:  # else the sum over steps is not known
            widths = np.diff(time)
            trapezoid = np.zeros(n)
            trapezoid[1:] += widths / 2
            trapezoid[:-1] += widths / 2
            value, error = kept.scalar(trapezoid @ kept.value, trapezoid)
            diffusion, note = self_diffusion(self.case)
            found.append(
                Comparison(
                    f"diffusion coefficient up to {time[-1]:g} tau",
                    value,
                    error,
                    diffusion,
                    "a^2/tau",
                    note,
                )
            )
        crossing = max(self.case.box.size) ** 2 / (4 * np.pi**2 * coefficients.viscosity)
        window = np.isfinite(extra["tail"]) & (time <= crossing)
        if window.sum() >= 3:
            weight = np.where(window, extra["tail"], 0.0)  # as the noise is the same everywhere
            weight /= (weight**2).sum()
            value, error = kept.scalar(weight @ kept.value, weight)
            found.append(Comparison("ratio to the hydrodynamic tail", value, error, 1.0))
        return found
