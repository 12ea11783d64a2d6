"""SRD that conserves angular momentum."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.collision.protocol import (
    CollisionRule,
    coefficients,
    collide,
    contribute,
    freedom,
)
from mesokit.method.mpcd.collision.rotation import (
    SPREAD,
    angular_speed,
    angular_velocity,
    central,
    cross,
    random_axis,
    rotate,
    second_moment,
    spread_out,
    turn,
)
from mesokit.method.mpcd.collision.srd import HALF_TURN
from mesokit.method.mpcd.thermostat.protocol import root_of_ratio, target
from mesokit.scalar.vector import added, added_scaled, chosen, dot, scaled

ONE = np.uint64(1)


@component
class SRDPlusA(CollisionRule):
    """Rotate relative velocities, then restore the angular momentum and energy of the cell.

    Source: Noguchi and Gompper, Phys. Rev. E 78, 016706 (2008).
    """

    rule: Literal["srd+a"] = tag("srd+a")
    angle: float = param(
        130.0, doc="rotation angle", symbol=r"\alpha", unit="degrees", gt=0, le=180
    )

    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum", "energy", "angular momentum")
    needs_energy: ClassVar[bool] = True
    one_temperature: ClassVar[bool] = False
    operations: ClassVar[float] = 190.0
    rates: ClassVar[dict[int, float]] = {2: 120.0, 3: 40.0}

    def kernel(self, dimension: int, kT: float) -> SRDPlusA2 | SRDPlusA3:
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        return SRDPlusA2(c, s) if dimension == 2 else SRDPlusA3(c, s)

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        """m r, m r r, and m r v: as r x v and r . v in 2D, as the whole tensor in 3D."""
        if dimension == 2:
            return ("mass",) * 3 + ("momentum",) * 2
        return ("mass",) * 9 + ("momentum",) * 9

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        return 5 if dimension == 2 else 12

    def problems(self, dimension: int) -> Iterator[str]:
        if self.angle == 180 and dimension == 2:
            yield HALF_TURN

    def in_theory(self) -> dict[str, Any]:
        return {"rule": "srd+a", "angle": self.angle}


class SRDPlusA2(NamedTuple):
    """Rotation by +angle or -angle in the plane."""

    cos: float
    sin: float


class SRDPlusA3(NamedTuple):
    """Rotation by the angle about a random axis."""

    cos: float
    sin: float


@contribute.register(SRDPlusA2)
def _(rule, counter, key, m, v, r):
    x, y = m * r[0], m * r[1]
    turn, pull = x * v[1] - y * v[0], x * v[0] + y * v[1]
    return v, (x, y, x * r[0] + y * r[1], turn, pull)


@contribute.register(SRDPlusA3)
def _(rule, counter, key, m, v, r):
    p = scaled(m, v)
    tensor = scaled(r[0], p) + scaled(r[1], p) + scaled(r[2], p)
    return v, scaled(m, r) + scaled(m, second_moment(r)) + tensor


freedom.register(SRDPlusA2)(lambda rule, n: 2.0 * (n - 1.0) - 1.0)
freedom.register(SRDPlusA3)(lambda rule, n: 3.0 * (n - 1.0) - (3.0 if n > 2.5 else 2.0))


# Below, w are the rotated velocities relative to the mean, Omega their rigid rotation and omega
# that of the cell before the collision. Particles leave with u + omega x r' + s (w - Omega x r'),
# r' relative to the centre of mass; s makes up for the energy of the two rotations. Where hardly
# any energy is left for s to scale (two particles whose w is all rotation) nothing is rotated:
# rounding would be all that is scaled, and the energy would not be conserved. A thermostat acts in
# such cells too.
LEAST_SHARE = 1e-2


@coefficients.register(SRDPlusA2)
def _(rule, thermostat, variate, chance, cell):
    mass, momentum, sums = cell.mass, cell.momentum, cell.sums
    share = 1.0 / mass
    ux, uy = momentum[0] * share, momentum[1] * share
    x, y = sums[0] * share, sums[1] * share
    inertia = sums[2] - mass * (x * x + y * y)
    spun = sums[3] - mass * (x * uy - y * ux)
    pull = sums[4] - mass * (x * ux + y * uy)
    sin = rule.sin * (1.0 - 2.0 * float(np.int64(chance[0] & ONE)))
    rotated_turn = rule.cos * spun + sin * pull
    relative = 0.5 * (cell.energy - mass * (ux * ux + uy * uy))
    omega = angular_speed(cell.number, mass, inertia, spun)
    omega_rotated = angular_speed(cell.number, mass, inertia, rotated_turn)
    before = relative - 0.5 * omega * spun
    after = relative - 0.5 * omega_rotated * rotated_turn
    apart = cell.number > 1.5 and inertia > SPREAD * mass
    collides = apart and before > 0.0 and after > LEAST_SHARE * before
    free = freedom(rule, cell.number)
    wanted = target(thermostat, variate, free, before)
    s = root_of_ratio(wanted, after if collides else before, free, 1e-9 * wanted)
    cos, sin = (s * rule.cos, s * sin) if collides else (s, 0.0)
    omega = omega - s * (omega_rotated if collides else omega)
    return (
        cos,
        sin,
        omega,
        ux - (cos * ux - sin * uy) + omega * y,
        uy - (sin * ux + cos * uy) - omega * x,
    )


@coefficients.register(SRDPlusA3)
def _(rule, thermostat, variate, chance, cell):
    mass, momentum, sums = cell.mass, cell.momentum, cell.sums
    share = 1.0 / mass
    u = momentum[0] * share, momentum[1] * share, momentum[2] * share
    r = sums[0] * share, sums[1] * share, sums[2] * share
    moment = central(sums[3:9], mass, r)
    # rows of sum m r' w before the rotation
    tx = added(sums[9:12], scaled(-mass * r[0], u))
    ty = added(sums[12:15], scaled(-mass * r[1], u))
    tz = added(sums[15:18], scaled(-mass * r[2], u))
    moment_of_momentum = ty[2] - tz[1], tz[0] - tx[2], tx[1] - ty[0]
    axis = random_axis(chance[0], chance[1])
    tx = rotate(tx, axis, rule.cos, rule.sin)
    ty = rotate(ty, axis, rule.cos, rule.sin)
    tz = rotate(tz, axis, rule.cos, rule.sin)
    rotated_moment = ty[2] - tz[1], tz[0] - tx[2], tx[1] - ty[0]
    omega = angular_velocity(cell.number, mass, moment, moment_of_momentum)
    omega_rotated = angular_velocity(cell.number, mass, moment, rotated_moment)
    relative = 0.5 * (cell.energy - mass * dot(u, u))
    before = relative - 0.5 * dot(omega, moment_of_momentum)
    after = relative - 0.5 * dot(omega_rotated, rotated_moment)
    apart = cell.number > 1.5 and spread_out(cell.number, mass, moment)
    collides = apart and before > 0.0 and after > LEAST_SHARE * before
    free = freedom(rule, cell.number)
    wanted = target(thermostat, variate, free, before)
    s = root_of_ratio(wanted, after if collides else before, free, 1e-9 * wanted)
    cos = s * rule.cos if collides else s
    sin = s * rule.sin if collides else 0.0
    along = s * (1.0 - rule.cos) if collides else 0.0
    spin = added_scaled(omega, -s, chosen(collides, omega_rotated, omega))
    rest = added_scaled(u, -1.0, turn(u, axis, cos, sin, along))
    return axis + (cos, sin, along) + spin + added(rest, cross(r, spin))


@collide.register(SRDPlusA2)
def _(rule, c, v, r):
    return (
        c[3] + (c[0] * v[0] - c[1] * v[1]) - c[2] * r[1],
        c[4] + (c[1] * v[0] + c[0] * v[1]) + c[2] * r[0],
    )


@collide.register(SRDPlusA3)
def _(rule, c, v, r):
    w = turn(v, (c[0], c[1], c[2]), c[3], c[4], c[5])
    return added(added(w, cross((c[6], c[7], c[8]), r)), (c[9], c[10], c[11]))
