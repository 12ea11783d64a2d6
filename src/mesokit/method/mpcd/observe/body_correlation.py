"""Correlation of the velocity, the angular velocity or the orientation of bodies at two times."""

import math
from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, option, param, tag
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY
from mesokit.method.mpcd.observe.shared.bodies_in_time import BodiesInTime, free_axes
from mesokit.observe.shared.fitted import fitted_number
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined

LABELS = {
    "velocity": "velocity autocorrelation",
    "angular velocity": "angular-velocity autocorrelation",
    "orientation": "orientation correlation",
}
MEMORIES = 4.0  # of the slowest flow, after which its share of an integral is left out
UNITS = {"velocity": "a^2/tau^2", "angular velocity": "1/tau^2", "orientation": ""}


@component
class BodyCorrelation(Observable):
    """Mean product of the velocity of a body at two times, or of its angular velocity, one
    component; or of its direction, which is the cosine of the angle that it has turned through.

    Velocities begin at kT/M (1 - M/M_all) where the momentum of all is zero, angular velocities at
    kT/I; their integrals are diffusion coefficients. Beside those of one sphere in a cube stands
    drag with the memory of the fluid (`theory.sphere_vacf`), once sound has passed. Axes along
    which the fluid flows or that a wall closes are left out. The direction is that of axis x of
    the body: in d dimensions it is forgotten as exp(-(d - 1) D_r t).
    """

    quantity: Literal["body-correlation"] = tag("body-correlation")
    drawing = "memory"
    of: Literal["velocity", "angular velocity", "orientation"] = param(
        "velocity", doc="what is remembered"
    )
    kind: int | str = param(1, doc=KIND_OF_BODY)
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)
    max_lag: int = param(200, doc="longest lag", unit="steps", ge=1)

    def axes(self, case: Case) -> tuple[int, ...]:
        """Axes that count. Raises CaseError without any, or without such bodies."""
        found = free_axes(case, self, turns=self.of != "velocity")
        return tuple(range(case.box.dimension)) if self.of == "orientation" else found

    def check(self, case: Case) -> None:
        """Raise CaseError without bodies that move or turn so."""
        self.axes(case)


def _product(old: Array, new: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", old, new))


@accumulator_of(BodyCorrelation)
class BodyCorrelationAccumulator(BodiesInTime):
    """Velocities, angular velocities or directions at many origins."""

    def observe(self, fluid: Any) -> None:
        bodies, of = fluid.bodies, self.observable.of
        if of == "velocity":
            remembered = bodies.velocities
        else:
            remembered = bodies.headings if of == "orientation" else bodies.spins
        self.origins.add(remembered[self.of.rows][:, self.axes], _product)

    def result(self) -> Result:
        of, kept = self.observable.of, self.origins.estimate()
        if of != "orientation":
            kept = kept.divided(len(self.axes))
        time = self.origins.sampled() * self.observable.every * self.case.fluid.timestep
        turns, directed = of == "angular velocity", of == "orientation"
        memory = None if directed else self.of.memory(time, turns)
        given = self.decay(time, kept) if directed else self.level(time, kept, memory)
        return self.report(
            {"time": time},
            kept,
            list(given),
            label=f"{LABELS[of]} of {self.of.name}",
            drawing="curve" if directed else "memory",
            units={"value": UNITS[of], "time": "tau"},
            samples=self.origins.count,
            extra={} if memory is None else {"tail": memory},
        )

    def level(self, time: Array, kept: Estimate, memory: Array | None) -> Iterator[Comparison]:
        """Equipartition, the diffusion coefficient, and what the memory of the fluid leaves."""
        n, turns = len(time), self.observable.of == "angular velocity"
        if not n:
            return
        known = self.of.spin_square() if turns else self.of.velocity_square()
        first = np.eye(n)[0]
        value, error = kept.total(first)
        error = self.of.with_start(error, value, self.origins.series)
        yield Comparison("value at lag 0", value, error, known, UNITS[self.observable.of])
        if n < 3:
            return
        trapezoid = np.zeros(n)
        trapezoid[1:] += np.diff(time) / 2
        trapezoid[:-1] += np.diff(time) / 2
        expected, note = self.of.rotational_diffusion() if turns else self.of.diffusion()
        what = f"{'rotational ' * turns}diffusion coefficient up to {time[-1]:g} tau"
        unit = "1/tau" if turns else "a^2/tau"
        note = joined(self.of.carried(turns), note)
        note = joined("" if turns else self.cut_short(float(time[-1])), note)
        yield fitted_number(what, *kept.total(trapezoid), expected, unit, note)
        first_time, last_time = self.of.memory_holds()
        window = (time >= first_time) & (time <= last_time)
        if memory is not None and window.sum() >= 3:
            weight = np.where(window, memory, 0.0)  # as the noise is the same everywhere
            weight /= (weight**2).sum()
            note = "drag with the memory of the fluid, without slip"
            yield Comparison("ratio to the hydrodynamic tail", *kept.total(weight), 1.0, "", note)

    def cut_short(self, last: float) -> str:
        """A note where the fluid still carries bodies on at the last lag; "" where it hardly does.

        The slowest shear mode of a box of length L decays in L^2/(4 pi^2 nu).
        """
        coefficients, case = setting.solvent(self.case), self.case
        closed = closed_axes(case.walls)
        lengths = [
            length
            for axis, length in zip(case.box.axes, case.box.size, strict=True)
            if axis not in closed
        ]
        if coefficients is None or not lengths:
            return ""
        longest = max(lengths)
        slowest = longest**2 / (4 * math.pi**2 * coefficients.viscosity)
        if last >= MEMORIES * slowest:
            return ""
        enough = math.ceil(MEMORIES * slowest / case.fluid.timestep)
        return (
            f"approximate: a lower bound, as the slowest flow in the box lasts {slowest:.2g} tau; "
            f"max_lag = {enough} is enough"
        )

    def decay(self, time: Array, kept: Estimate) -> Iterator[Comparison]:
        """The rotational diffusion coefficient, from the lag at which 1/e is left, or nearly."""
        use = np.flatnonzero((kept.value > 0) & (time > 0))
        if not len(use):
            return
        at = use[abs(np.log(kept.value[use]) + 1).argmin()]
        rate = (self.case.box.dimension - 1) * float(time[at])
        value, left = -math.log(kept.value[at]) / rate, float(kept.value[at])
        _, error = kept.scalar(value, -np.eye(len(time))[at] / (left * rate))
        expected, note = self.of.rotational_diffusion()
        what = "rotational diffusion coefficient"
        yield fitted_number(what, value, error, expected, "1/tau", note)
