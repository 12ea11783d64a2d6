"""A kind of bodies that an observable follows, and what theory knows of it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import one_of, show
from mesokit.errors import CaseError
from mesokit.method.mpcd.body.protocol import named
from mesokit.method.mpcd.columns import holds, kinds_of_bodies, total_mass, turns
from mesokit.method.mpcd.expected import setting

Floats = NDArray[np.float64]
KIND_OF_BODY = "which kind of bodies: name or number, from 1"
ROUNDING = 1e-12  # of a moment of inertia


class Followed(NamedTuple):
    """Bodies of one kind: its place among the kinds, its name, and the rows of its bodies.

    `moments` (3,) are the principal moments of inertia, about `axes` (3, 3), columns in the body's
    frame: its own axes where they are principal ones.
    """

    case: Case
    place: int
    name: str
    kind: Any
    rows: slice
    mass: float
    moments: Floats
    axes: Floats

    @property
    def number(self) -> int:
        """How many bodies."""
        return self.rows.stop - self.rows.start

    @property
    def turning(self) -> tuple[int, ...]:
        """Axes, of three, about which they turn freely: in 2D about z alone."""
        dimension = self.case.box.dimension
        if self.kind.hinge is not None and dimension == 3:
            return ()
        return ((), (2,), (), (0, 1, 2))[turns(self.kind, dimension)]

    @property
    def moving(self) -> tuple[int, ...]:
        """Axes along which they move freely."""
        return tuple(k for k, name in enumerate(self.case.box.axes) if name not in self.kind.fixed)

    @property
    def thermal(self) -> bool:
        """Whether they are in equilibrium with a fluid at rest."""
        return not setting.driven(self.case)

    @property
    def free_share(self) -> float:
        """1 - M/M_all where the momentum of all is 0 and kept, else 1."""
        if self.case.walls or holds(self.case):
            return 1.0
        number = sum(group.number for group in self.case.groups)
        return 1.0 - self.mass / total_mass(self.case, number)

    def with_start(self, error: float, value: float, runs: int = 1) -> float:
        """The error of a number that grows as kT, with what the starts of so many runs add.

        Virtual particles bring a fluid that keeps its energy to kT, but slowly.
        """
        return setting.with_start(self.case, error, value, runs)

    # What theory knows, nan where it knows nothing: a value and a note on it.

    def velocity_square(self) -> float:
        """Mean square of a component of the velocity."""
        kT = float(self.case.fluid.kT)
        return kT / self.mass * self.free_share if self.thermal and self.moving else math.nan

    def spin_square(self) -> float:
        """Mean square of a component of the angular velocity, the mean over its axes."""
        if not (self.thermal and self.turning):
            return math.nan
        kT = float(self.case.fluid.kT)
        return float(np.mean([kT / self.moments[k] for k in self.turning]))

    def diffusion(self) -> tuple[float, str]:
        """Diffusion coefficient of the centres in this box."""
        return math.nan, ""

    def rotational_diffusion(self) -> tuple[float, str]:
        """Rotational diffusion coefficient."""
        return math.nan, ""

    def mobility(self) -> tuple[float, str]:
        """Velocity over force in this box."""
        return math.nan, ""

    def rotational_mobility(self) -> tuple[float, str]:
        """Angular velocity over torque."""
        return math.nan, ""


def followed(case: Case, quantity: str, kind: int | str = 1) -> Followed:
    """A kind of bodies, by its name or number from 1. Raises CaseError where there is none."""
    if not case.bodies:
        raise CaseError(f"{quantity} needs bodies that move in the fluid; give [[bodies]]")
    names = [one.name for one in named(case.bodies)]
    if kind in names:
        place = names.index(str(kind))
    elif isinstance(kind, int) and 1 <= kind <= len(names):
        place = kind - 1
    else:
        known = one_of([*names, *range(1, len(names) + 1)])
        raise CaseError(f"kind = {show(kind)}: expected {known}")
    numbers = [one.number for one in case.bodies]
    first, mass = sum(numbers[:place]), kinds_of_bodies(case)[place].mass
    solid = case.bodies[place].solid(case.box.dimension)
    inertia = mass / solid.volume * solid.moments
    moments, axes = np.diag(inertia), np.eye(3)
    if abs(inertia - np.diag(moments)).max() > ROUNDING * moments.max():
        moments, axes = np.linalg.eigh(inertia)
    rows = slice(first, first + numbers[place])
    return Followed(case, place, names[place], case.bodies[place], rows, mass, moments, axes)


def every_kind(case: Case, quantity: str) -> list[Followed]:
    """All kinds of bodies. Raises CaseError where there are none."""
    return [followed(case, quantity, number) for number in range(1, max(len(case.bodies), 1) + 1)]
