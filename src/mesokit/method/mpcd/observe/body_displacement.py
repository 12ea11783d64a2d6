"""Mean square displacement of bodies, and of the angles through which they turn."""

import math
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, option, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY, followed
from mesokit.method.mpcd.expected.setting import quiet_axes
from mesokit.observe.mean_square_displacement import late_slope
from mesokit.observe.shared.fitted import fitted_number
from mesokit.observe.shared.origins import Origins
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Result, joined

GROWS = "approximate: grows with the lag: no straight line yet, a larger max_lag"


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
        kind = followed(case, self.quantity, self.kind)
        if self.of == "angles":
            found = kind.turning
        else:
            found = tuple(axis for axis in quiet_axes(case) if axis in kind.moving)
        if not found:
            moves = "moves along" if self.of == "places" else "turns about"
            raise CaseError(f"of = {self.of!r}: {kind.name} {moves} no axis freely")
        return found

    def check(self, case: Case) -> None:
        """Raise CaseError without bodies that move or turn so."""
        self.axes(case)


def _square_distance(old: Array, new: Array) -> Array:
    difference = new - old
    return np.asarray(np.einsum("ij,ij->i", difference, difference))


@accumulator_of(BodyDisplacement)
class BodyDisplacementAccumulator(BlockAccumulator):
    """Unwrapped places or angles at many origins."""

    memory: ClassVar[tuple[str, ...]] = ("origins",)

    def prepare(self) -> None:
        observable = self.observable
        self.of = followed(self.case, observable.quantity, observable.kind)
        self.axes = list(observable.axes(self.case))
        max_lag = max(1, observable.max_lag // observable.every)
        self.origins = Origins(self.of.number, len(self.axes), max_lag)

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
        slope, found = late_slope(time, moved, self._diffusive_from()), []
        if slope is not None:
            scale, (known, note) = 1 / (2 * len(self.axes)), of()
            note = joined(GROWS if slope.growth and not slope.straight else "", note)
            what = "rotational diffusion coefficient" if angles else "diffusion coefficient"
            unit = "1/tau" if angles else "a^2/tau"
            number = slope.value * scale, slope.error * scale
            found.append(fitted_number(what, *number, known, unit, note))
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
        theory of the diffusion coefficient; 0 without one."""
        angles = self.observable.of == "angles"
        known, _ = self.of.rotational_diffusion() if angles else self.of.diffusion()
        moved = self.of.spin_square() if angles else self.of.velocity_square()
        decay = 5 * known / moved
        return decay if math.isfinite(decay) else 0.0
