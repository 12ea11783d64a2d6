"""Andersen thermostat collisions: draw the velocities of a cell anew about their mean."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, ClassVar, Literal, NamedTuple

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.method.mpcd.collision.protocol import (
    CollisionRule,
    Gas,
    coefficients,
    collide,
    contribute,
    freedom,
)
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import PARTICLE_VELOCITY, normals, words
from mesokit.scalar.vector import added, scaled


@component
class AT(CollisionRule):
    """Draw relative velocities from the Maxwell distribution; momentum is conserved (MPC-AT-a).

    It is its own thermostat.
    Source: Noguchi, Kikuchi and Gompper, EPL 78, 10005 (2007).
    """

    rule: Literal["at"] = tag("at")

    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum")
    isothermal: ClassVar[bool] = True
    operations: ClassVar[float] = 205.0
    rates: ClassVar[dict[int, float]] = {2: 80.0, 3: 58.0}

    def kernel(self, dimension: int, kT: float) -> AT2 | AT3:
        return AT2(kT) if dimension == 2 else AT3(kT)

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        return ("momentum",) * dimension

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        return dimension

    def in_theory(self) -> dict[str, Any]:
        return {"rule": "at"}

    def bead_diffusion(
        self, gas: Gas, mass: float, others: Sequence[tuple[float, float]] = ()
    ) -> float:
        return theory.bead_diffusion(
            "at", gas.dimension, gas.density, gas.timestep, None, mass, gas.kT, gas.mass, *others
        )


class AT2(NamedTuple):
    """Thermal energy of the drawn velocities."""

    kT: float


class AT3(NamedTuple):
    """Thermal energy of the drawn velocities."""

    kT: float


@scalar
def thermal_velocity(counter, key, kT, m, pattern):
    """A velocity from the Maxwell distribution, with as many components as `pattern`."""
    a, b, c, d = words(counter, PARTICLE_VELOCITY, key[0], key[1])
    return scaled(math.sqrt(kT / m), normals(pattern, a, b, c, d))


@contribute.register(AT2, AT3)
def _(rule, counter, key, m, v, r):
    w = thermal_velocity(counter, key, rule.kT, m, v)
    return w, scaled(m, w)


freedom.register(AT2)(lambda rule, n: 2.0 * (n - 1.0))
freedom.register(AT3)(lambda rule, n: 3.0 * (n - 1.0))


@coefficients.register(AT2)
def _(rule, thermostat, variate, chance, cell):
    drawn = cell.sums[0], cell.sums[1]
    return scaled(1.0 / cell.mass, added(cell.momentum, scaled(-1.0, drawn)))


@coefficients.register(AT3)
def _(rule, thermostat, variate, chance, cell):
    drawn = cell.sums[0], cell.sums[1], cell.sums[2]
    return scaled(1.0 / cell.mass, added(cell.momentum, scaled(-1.0, drawn)))


collide.register(AT2)(lambda rule, c, v, r: (v[0] + c[0], v[1] + c[1]))
collide.register(AT3)(lambda rule, c, v, r: (v[0] + c[0], v[1] + c[1], v[2] + c[2]))
