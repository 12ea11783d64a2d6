"""Mean square displacement of bodies, and of the angles through which they turn."""

import math
from typing import Any, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, option, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY
from mesokit.method.mpcd.observe.shared.bodies_in_time import BodiesInTime, free_axes
from mesokit.observe.mean_square_displacement import late_slope
from mesokit.observe.shared.fitted import fitted_number
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Result, joined

GROWS = "approximate: grows with the lag: no straight line yet, a larger max_lag"
LIVES = 2.0  # of the longest wave of the box, after which displacements are nearly diffusive


@component
class BodyDisplacement(Observable):
    """Mean square displacement of the centres of bodies, or of the angles that they turn through.

    The slope gives the diffusion coefficient, or the rotational one: 2 n D t of n axes. Axes along
    which the fluid flows or that a wall closes are left out. Angles are angular velocities summed
    over time, about the axes of the box: in 2D about z alone.
    """

    quantity: Literal["body-displacement"] = tag("body-displacement")
    drawing = "displacement"
    of: Literal["places", "angles"] = param("places", doc="what moves")
    kind: int | str = param(1, doc=KIND_OF_BODY)
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)
    max_lag: int = param(1000, doc="longest lag", unit="steps", ge=1)

    def axes(self, case: Case) -> tuple[int, ...]:
        """Axes that count. Raises CaseError without any, or without such bodies."""
        return free_axes(case, self, turns=self.of == "angles")

    def check(self, case: Case) -> None:
        """Raise CaseError without bodies that move or turn so."""
        self.axes(case)


def _square_distance(old: Array, new: Array) -> Array:
    difference = new - old
    return np.asarray(np.einsum("ij,ij->i", difference, difference))


@accumulator_of(BodyDisplacement)
class BodyDisplacementAccumulator(BodiesInTime):
    """Unwrapped places or angles at many origins."""

    def observe(self, fluid: Any) -> None:
        bodies = fluid.bodies
        angles = self.observable.of == "angles"
        moved = bodies.angles if angles else bodies.places(unwrapped=True)
        self.origins.add(moved[self.of.rows][:, self.axes], _square_distance)

    def result(self) -> Result:
        """The curve and its slope where it is a straight line."""
        steps, moved = self.origins.sampled() * self.observable.every, self.origins.estimate()
        time, angles = steps * self.case.fluid.timestep, self.observable.of == "angles"
        label, of = "mean square displacement", self.of.diffusion
        if angles:
            label, of = "mean square angular displacement", self.of.rotational_diffusion
        first, last = self._diffusive_from(), float(time.max(initial=0.0))
        slope, found = late_slope(time, moved, min(first, last / 2)), []
        if slope is not None:
            scale, (known, note) = 1 / (2 * len(self.axes)), of()
            enough = math.ceil(2 * first / self.case.fluid.timestep)
            short = f"approximate: a lower bound at such short lags: max_lag = {enough} is enough"
            note = joined(GROWS if slope.growth and not slope.straight else "", note)
            note = joined(self.of.carried(angles), note)
            note = joined(short if first > last / 2 else "", note)
            what = "rotational diffusion coefficient" if angles else "diffusion coefficient"
            unit = "1/tau" if angles else "a^2/tau"
            runs, timestep = self.origins.series, self.case.fluid.timestep
            length = self.origins.count / runs * self.observable.every * timestep
            walks = runs * self.of.number * len(self.axes)
            error = slope.error_of_walks(time, length, walks) * scale
            found.append(fitted_number(what, slope.value * scale, error, known, unit, note))
        return self.report(
            {"time": time},
            moved,
            found,
            label=f"{label} of {self.of.name}",
            units={"value": "" if angles else "a^2", "time": "tau"},
            fit=None if slope is None else slope.line,
            samples=self.origins.count,
            extra={"components": "".join("xyz"[axis] for axis in self.axes)},
        )

    def _diffusive_from(self) -> float:
        """The lag from which on it is a straight line: five times in which a velocity decays, by
        theory of the diffusion coefficient, and of places `LIVES` of the longest wave."""
        angles = self.observable.of == "angles"
        known, _ = self.of.rotational_diffusion() if angles else self.of.diffusion()
        moved = self.of.spin_square() if angles else self.of.velocity_square()
        decay = 5 * known / moved
        times = [decay if math.isfinite(decay) else 0.0]
        if not angles and (coefficients := setting.solvent(self.case)) is not None:
            times.append(LIVES / (coefficients.viscosity * self._longest_wave() ** 2))
        return max(times)

    def _longest_wave(self) -> float:
        """The wave number of the flow that lives longest: between walls half a wave."""
        size = self.case.box.size
        between = [math.pi / size[axis] for axis in setting.closed_axes(self.case)]
        return max(between) if between else 2 * math.pi / max(size)
