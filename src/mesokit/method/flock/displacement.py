"""What is expected of the mean square displacement of birds."""

import math
from typing import Any

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.observe import mean_square_displacement
from mesokit.seam.engine import Array, Integers

LATE = 5.0  # times in which a heading is forgotten, after which the way is a random walk


class Displacement(mean_square_displacement.Displacement):
    """That of one bird alone is a walk whose steps remember; of others there is no theory.

    Raises CaseError for molecules and kinds, of which there are none, and without an axis to count.
    """

    def __init__(self, case: Case, observable: Any) -> None:
        if observable.of != "particles":
            raise CaseError(
                f"of = {show(observable.of)}: expected 'particles'; birds are no molecules"
            )
        if observable.kind is not None:
            raise CaseError(
                f"kind = {show(observable.kind)}: there is one kind of birds; leave it out"
            )
        shut = closed_axes(case.walls)
        free = [axis for axis in case.box.axes if axis not in shut]
        self.axes = tuple(
            case.box.index(axis, "components") for axis in (observable.components or free)
        )
        if not self.axes:
            raise CaseError("components: walls close all axes; expected the axes that count")
        given, d = case.flock, case.box.dimension
        self.length, self.number, self.dimension = 1, case.particles, d
        self.step_length, self.timestep = given.speed * given.timestep, given.timestep
        alone = case.particles == 1 and given.cohesion is None and not case.walls
        self.memory = given.noise.memory(d) if alone else math.nan

    def expected(self, steps: Integers) -> Array | None:
        """That of a persistent walk, of a bird alone."""
        if math.isnan(self.memory):
            return None
        share = len(self.axes) / self.dimension
        return theory.msd_persistent_walk(steps, self.step_length, self.memory, share)

    def coefficient(self) -> tuple[float, str]:
        """Of a bird alone."""
        if math.isnan(self.memory):
            return math.nan, "birds among others have no theory"
        walk = theory.persistent_diffusion(
            self.step_length, self.timestep, self.memory, self.dimension
        )
        return (walk, "a lone bird") if math.isfinite(walk) else (math.nan, "a straight flight")

    def diffusive_from(self) -> float:
        """Time in which a lone bird forgets its heading; infinite where it is unknown."""
        if math.isnan(self.memory) or self.memory >= 1:
            return float("inf")
        if self.memory <= 0:
            return self.timestep
        return LATE * self.timestep / -math.log(self.memory)

    def legend(self) -> str:
        """The walk of one bird."""
        return "persistent walk"
