"""Two species that demix: rotations that turn the flux of colour up the gradient of colour."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.collision.directed import direction, quaternion, turned_by
from mesokit.method.mpcd.collision.protocol import (
    CollisionRule,
    coefficients,
    collide,
    contribute,
    freedom,
)
from mesokit.method.mpcd.collision.srd import turned_cell, turned_in_plane
from mesokit.method.mpcd.thermostat.protocol import stretch
from mesokit.scalar.jit import optional, scalar
from mesokit.scalar.vector import added_scaled, dot, scaled


@component
class Demix(CollisionRule):
    """Rotate relative velocities so that each of two species moves to where there is more of it.

    Particles have colour +1 (the first species) or -1. The flux of colour of a cell is q, the sum
    of colour times relative velocity over the thermal speed; C is the colour of a cell. A rotation
    of the relative velocities has the probability exp(coupling q . grad C), q being the flux after
    it. With coupling 0 it is SRD by uniform angles.

    Source: Inoue, Chen and Ohashi, J. Comput. Phys. 201, 191 (2004), where the flux points up the
    gradient; with Boltzmann's weight Kapral, Adv. Chem. Phys. 140, 89 (2008).
    """

    rule: Literal["demix"] = tag("demix")
    coupling: float = param(
        0.05, doc="how strongly colour moves up its gradient", unit="a", ge=0, le=100
    )

    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum", "energy")
    rates: ClassVar[dict[int, float]] = {2: 60.0, 3: 30.0}
    gradient_of: ClassVar[int | None] = 0
    kinds: ClassVar[int | None] = 2
    ideal: ClassVar[bool] = False
    one_temperature: ClassVar[bool] = False

    def kernel(self, dimension: int, kT: float) -> Turning2 | Turning3:
        """Parameters for the scalar functions below, if all particles are of one kind."""
        kind = Turning2 if dimension == 2 else Turning3
        return kind(self.coupling / math.sqrt(kT), 2**60, 2**60)

    def among(self, kernel: Any, counts: tuple[int, ...], mass: float) -> Turning2 | Turning3:
        strength = kernel.strength / (mass * math.sqrt(mass))
        return type(kernel)(strength, counts[0], sum(counts))

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        return ("mass",) + ("momentum",) * dimension

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        return 4 if dimension == 2 else 7 + stretched


class Turning2(NamedTuple):
    """Coupling over mass^(3/2) kT^(1/2); how many particles the first, and both species have."""

    strength: float
    first: int
    every: int


class Turning3(NamedTuple):
    """The same in 3D."""

    strength: float
    first: int
    every: int


@scalar
def colour(rule, key):
    """+1 for the first species, -1 for the other, 0 for the virtual particles of walls."""
    number = np.int64(key[0])
    return 1.0 if number < rule.first else (-1.0 if number < rule.every else 0.0)


@contribute.register(Turning2, Turning3)
def _(rule, counter, key, m, v, r):
    charge = m * colour(rule, key)
    return v, ((charge,) + scaled(charge, v))


freedom.register(Turning2)(lambda rule, n: 2.0 * (n - 1.0))
freedom.register(Turning3)(lambda rule, n: 3.0 * (n - 1.0))


@coefficients.register(Turning2)
def _(rule, thermostat, variate, chance, cell):
    momentum, sums, share = cell.momentum, cell.sums, 1.0 / cell.mass
    u = momentum[0] * share, momentum[1] * share
    flux = sums[1] - sums[0] * u[0], sums[2] - sums[0] * u[1]
    x, y = direction(chance, rule.strength, flux, (sums[3], sums[4]))
    # from the flux to that direction: the product with the conjugate of the flux
    length = math.sqrt(flux[0] * flux[0] + flux[1] * flux[1])
    inverse = 1.0 / length if length > 0.0 else 0.0
    a, b = flux[0] * inverse if length > 0.0 else 1.0, flux[1] * inverse
    return turned_cell(rule, thermostat, variate, cell, x * a + y * b, y * a - x * b)


@coefficients.register(Turning3)
def _(rule, thermostat, variate, chance, cell):
    momentum, sums, share = cell.momentum, cell.sums, 1.0 / cell.mass
    u = momentum[0] * share, momentum[1] * share, momentum[2] * share
    flux = sums[1] - sums[0] * u[0], sums[2] - sums[0] * u[1], sums[3] - sums[0] * u[2]
    turn = quaternion(chance, rule.strength, flux, (sums[4], sums[5], sums[6]))
    relative = cell.energy - cell.mass * dot(u, u)
    s = stretch(thermostat, variate, freedom(rule, cell.number), 0.5 * relative)
    return u + turn + s


collide.register(Turning2)(turned_in_plane)


@collide.register(Turning3)
def _(rule, c, v, r):
    w = v[0] - c[0], v[1] - c[1], v[2] - c[2]
    w = turned_by((c[3], c[4], c[5], c[6]), w)
    return added_scaled((c[0], c[1], c[2]), optional(c[7:], 1.0), w)
