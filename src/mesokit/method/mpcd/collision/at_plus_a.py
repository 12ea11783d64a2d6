"""Andersen thermostat collisions that conserve angular momentum."""

from __future__ import annotations

from typing import Any, ClassVar, Literal, NamedTuple

from mesokit.case.component import component, tag
from mesokit.method.mpcd.collision.at import thermal_velocity
from mesokit.method.mpcd.collision.protocol import (
    CollisionRule,
    coefficients,
    collide,
    contribute,
    freedom,
)
from mesokit.method.mpcd.collision.rotation import (
    angular_speed,
    angular_velocity,
    central,
    cross,
    second_moment,
)
from mesokit.scalar.vector import added, scaled


@component
class ATPlusA(CollisionRule):
    """Draw relative velocities anew and restore the angular momentum of the cell (MPC-AT+a).

    It is its own thermostat.
    Source: Noguchi, Kikuchi and Gompper, EPL 78, 10005 (2007).
    """

    rule: Literal["at+a"] = tag("at+a")

    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum", "angular momentum")
    isothermal: ClassVar[bool] = True
    rates: ClassVar[dict[int, float]] = {2: 60.0, 3: 33.0}

    def kernel(self, dimension: int, kT: float) -> ATPlusA2 | ATPlusA3:
        return ATPlusA2(kT) if dimension == 2 else ATPlusA3(kT)

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        """Drawn momentum, m r, m r r, and the angular momentum that the draw would lose."""
        momentum = ("momentum",)
        if dimension == 2:
            return 2 * momentum + ("mass",) * 3 + momentum
        return 3 * momentum + ("mass",) * 9 + 3 * momentum

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        return 3 if dimension == 2 else 6

    def in_theory(self) -> dict[str, Any]:
        return {"rule": "at+a"}


class ATPlusA2(NamedTuple):
    """Thermal energy of the drawn velocities."""

    kT: float


class ATPlusA3(NamedTuple):
    """Thermal energy of the drawn velocities."""

    kT: float


@contribute.register(ATPlusA2)
def _(rule, counter, key, m, v, r):
    w = thermal_velocity(counter, key, rule.kT, m, v)
    lost = r[0] * (v[1] - w[1]) - r[1] * (v[0] - w[0])
    square = r[0] * r[0] + r[1] * r[1]
    return w, (m * w[0], m * w[1], m * r[0], m * r[1], m * square, m * lost)


@contribute.register(ATPlusA3)
def _(rule, counter, key, m, v, r):
    w = thermal_velocity(counter, key, rule.kT, m, v)
    lost = cross(r, (v[0] - w[0], v[1] - w[1], v[2] - w[2]))
    return w, (scaled(m, w) + scaled(m, r) + scaled(m, second_moment(r)) + scaled(m, lost))


freedom.register(ATPlusA2)(lambda rule, n: 2.0 * (n - 1.0) - 1.0)
freedom.register(ATPlusA3)(lambda rule, n: 3.0 * (n - 1.0) - (3.0 if n > 2.5 else 2.0))


@coefficients.register(ATPlusA2)
def _(rule, thermostat, variate, chance, cell):
    mass, momentum, sums = cell.mass, cell.momentum, cell.sums
    share = 1.0 / mass
    bx, by = (momentum[0] - sums[0]) * share, (momentum[1] - sums[1]) * share
    x, y = sums[2] * share, sums[3] * share
    inertia = sums[4] - mass * (x * x + y * y)
    lost = sums[5] - mass * (x * by - y * bx)
    omega = angular_speed(cell.number, mass, inertia, lost)
    return bx + omega * y, by - omega * x, omega


@coefficients.register(ATPlusA3)
def _(rule, thermostat, variate, chance, cell):
    mass, momentum, sums = cell.mass, cell.momentum, cell.sums
    share = 1.0 / mass
    b = (
        (momentum[0] - sums[0]) * share,
        (momentum[1] - sums[1]) * share,
        (momentum[2] - sums[2]) * share,
    )
    r = sums[3] * share, sums[4] * share, sums[5] * share
    moment = central(sums[6:12], mass, r)
    shift = cross(r, b)
    lost = sums[12] - mass * shift[0], sums[13] - mass * shift[1], sums[14] - mass * shift[2]
    omega = angular_velocity(cell.number, mass, moment, lost)
    return added(b, cross(r, omega)) + omega


@collide.register(ATPlusA2)
def _(rule, c, v, r):
    return v[0] + c[0] - c[2] * r[1], v[1] + c[1] + c[2] * r[0]


@collide.register(ATPlusA3)
def _(rule, c, v, r):
    return added(added(v, (c[0], c[1], c[2])), cross((c[3], c[4], c[5]), r))
