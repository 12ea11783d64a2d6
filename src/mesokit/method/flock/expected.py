"""Theory of flocks: displacement of a lone bird, polar order and number fluctuations."""

import math
from typing import Any, NamedTuple

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.observe import mean_square_displacement
from mesokit.seam.engine import Array, Integers

LATE = 5.0  # times in which a heading is forgotten, after which the way is a random walk
MANY = 30  # birds, from which on their sum at random is as good as normal
ORDERED = 0.8  # exponent of number fluctuations in large ordered flocks in 2D
IN_ORDER = 0.5  # polar order from which a flock is ordered
DISORDERED = 1.5  # times the order of directions at random, up to which a flock is disordered


class Displacement(mean_square_displacement.Displacement):
    """Displacement of a lone bird, a persistent walk; of others there is no theory.

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
        counted = observable.components or [axis for axis in case.box.axes if axis not in shut]
        if not counted:
            raise CaseError("components: walls close all axes; expected the axes that count")
        self.axes = tuple(case.box.index(axis, "components") for axis in counted)
        given, d = case.flock, case.box.dimension
        self.length, self.number, self.dimension = 1, case.particles, d
        self.step_length, self.timestep = given.speed * given.timestep, given.timestep
        alone = case.particles == 1 and given.cohesion is None and not case.walls
        self.memory = given.noise.memory(d) if alone else math.nan

    def expected(self, steps: Integers) -> Array | None:
        if math.isnan(self.memory):
            return None
        share = len(self.axes) / self.dimension
        return theory.msd_persistent_walk(steps, self.step_length, self.memory, share)

    def coefficient(self) -> tuple[float, str]:
        if math.isnan(self.memory):
            return math.nan, "birds among others have no theory"
        walk = theory.persistent_diffusion(
            self.step_length, self.timestep, self.memory, self.dimension
        )
        return (walk, "a lone bird") if math.isfinite(walk) else (math.nan, "a straight flight")

    def diffusive_from(self) -> float:
        """Time in which a lone bird loses its heading; infinite where it is unknown."""
        if not self.memory < 1:
            return math.inf
        if self.memory <= 0:
            return self.timestep
        return LATE * self.timestep / -math.log(self.memory)

    def legend(self) -> str:
        return "persistent walk"


def at_random(case: Case) -> bool:
    """True if birds fly at random, whatever the others do."""
    noise, d = case.flock.noise, case.box.dimension
    if case.flock.cohesion is not None or noise.memory(d) >= 1e-12:
        return False
    crowd = noise.crowd(d, 1)
    return crowd is not None and crowd.many < 1e-12


class KnownOrder(NamedTuple):
    """Mean, mean square and Binder cumulant of the polar order, nan without a theory, and a note
    on the theory or on its absence."""

    order: float = math.nan
    square: float = math.nan
    cumulant: float = math.nan
    note: str = ""


def polar_order(case: Case) -> KnownOrder:
    """Theory of the polar order of a case."""
    number, d = case.particles, case.box.dimension
    if case.flock.cohesion is not None:
        return KnownOrder(note="no theory with cohesion")
    if at_random(case):
        square, note = 1 / number, "directions at random"
        if number < MANY:
            return KnownOrder(square=square, note=note)
        order, cumulant = theory.disordered_order(number, d), theory.disordered_binder(d)
        return KnownOrder(order, square, cumulant, note)
    shut = closed_axes(case.walls)
    farthest = [
        length if axis in shut else 0.5 * length
        for axis, length in zip(case.box.axes, case.box.size, strict=True)
    ]
    all_in_reach = math.hypot(*farthest) < case.flock.radius
    crowd = case.flock.noise.crowd(d, number) if all_in_reach else None
    if crowd is None:
        return KnownOrder(note="no analytical theory")
    if math.isnan(crowd.many):
        return KnownOrder(note="all see all: order and disorder are both stable")
    if math.isnan(crowd.mean_square):
        return KnownOrder(note=f"all see all: {crowd.many:.4g} of many birds, these are too few")
    return KnownOrder(crowd.mean, crowd.mean_square, note="all see all")


def giant_exponent(case: Case, order: float) -> float:
    """Exponent of number fluctuations of large ordered flocks in 2D, nan of other flocks."""
    ordered = order >= IN_ORDER and case.box.dimension == 2 and not at_random(case)
    return ORDERED if ordered else math.nan


def number_exponent(case: Case, order: float, of_chance: float) -> tuple[float, str]:
    """Exponent of number fluctuations in flocks of a polar order, nan without a theory, and a note.

    `of_chance` is the exponent of birds at random in the same squares.
    """
    if at_random(case):
        return of_chance, "birds at random"
    note, giant = f"polar order {order:.2g}", giant_exponent(case, order)
    if order <= DISORDERED * theory.disordered_order(case.particles, case.box.dimension):
        return of_chance, f"approximate: disordered flocks, {note}"
    if math.isfinite(giant):
        return giant, f"approximate: large ordered flocks (Toner and Tu 1995), {note}"
    return math.nan, f"no theory for this flock, {note}"
