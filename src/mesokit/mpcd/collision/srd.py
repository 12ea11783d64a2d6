"""Stochastic rotation dynamics: rotate the velocities of a cell about their mean."""

from __future__ import annotations

import math
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from mesokit.component import component, param, tag
from mesokit.elementary import sincos_turn
from mesokit.mpcd.collision.protocol import coefficients, collide, contribute, freedom
from mesokit.mpcd.collision.rotation import random_axis, rotate
from mesokit.mpcd.thermostat.protocol import stretch
from mesokit.random import unit_open
from mesokit.scalar import added_scaled, mul_add, optional

ONE = np.uint64(1)


@component
class SRD:
    """Rotate relative velocities: in 3D about a random axis, in 2D with a random sign.

    Source: Malevanets and Kapral, J. Chem. Phys. 110, 8605 (1999).
    """

    rule: Literal["srd"] = tag("srd")
    angle: float = param(130.0, doc="rotation angle", unit="degrees", gt=0, le=180)
    angle_distribution: Literal["fixed", "uniform"] = param(
        "fixed", doc="'uniform' draws the angle of each cell from [0, 360), in 2D only"
    )

    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum", "energy")

    needs_energy: ClassVar[bool] = False

    def kernel(self, dimension: int, kT: float) -> SRD2 | SRD2Uniform | SRD3:
        """Parameters for the scalar functions below."""
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        if dimension == 3:
            return SRD3(c, s)
        return SRD2(c, s) if self.angle_distribution == "fixed" else SRD2Uniform(c)

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        """None: the momentum is enough."""
        return ()

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        """How many numbers `coefficients` gives; `stretched` says that a thermostat acts."""
        return 4 if dimension == 2 else 6 + stretched


class SRD2(NamedTuple):
    """Rotation by +angle or -angle in the plane."""

    cos: float
    sin: float


class SRD2Uniform(NamedTuple):
    """Rotation by a uniformly distributed angle in the plane."""

    cos: float


class SRD3(NamedTuple):
    """Rotation by the angle about a random axis."""

    cos: float
    sin: float


@contribute.register(SRD2, SRD2Uniform, SRD3)
def _(rule, counter, who, m, v, r):
    return v, ()


@freedom.register(SRD2, SRD2Uniform)
def _(rule, n):
    return 2.0 * (n - 1.0)


@freedom.register(SRD3)
def _(rule, n):
    return 3.0 * (n - 1.0)


@coefficients.register(SRD2)
def _(rule, thermostat, variate, chance, n, mass, momentum, energy, sums):
    share = 1.0 / mass
    u = momentum[0] * share, momentum[1] * share
    sign = 1.0 - 2.0 * float(np.int64(chance[0] & ONE))
    relative = energy - mass * (u[0] * u[0] + u[1] * u[1])
    s = optional(stretch(thermostat, variate, freedom(rule, n), 0.5 * relative), 1.0)
    return u[0], u[1], s * rule.cos, s * (sign * rule.sin)


@coefficients.register(SRD2Uniform)
def _(rule, thermostat, variate, chance, n, mass, momentum, energy, sums):
    share = 1.0 / mass
    u = momentum[0] * share, momentum[1] * share
    sin, cos = sincos_turn(unit_open(chance[0]))
    relative = energy - mass * (u[0] * u[0] + u[1] * u[1])
    s = optional(stretch(thermostat, variate, freedom(rule, n), 0.5 * relative), 1.0)
    return u[0], u[1], s * cos, s * sin


@coefficients.register(SRD3)
def _(rule, thermostat, variate, chance, n, mass, momentum, energy, sums):
    share = 1.0 / mass
    u = momentum[0] * share, momentum[1] * share, momentum[2] * share
    relative = energy - mass * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
    s = stretch(thermostat, variate, freedom(rule, n), 0.5 * relative)
    return u + random_axis(chance[0], chance[1]) + s


@collide.register(SRD2, SRD2Uniform)
def _(rule, c, v, r):
    wx, wy = v[0] - c[0], v[1] - c[1]
    x = mul_add(c[2], wx, mul_add(-c[3], wy, c[0]))
    return x, mul_add(c[3], wx, mul_add(c[2], wy, c[1]))


@collide.register(SRD3)
def _(rule, c, v, r):
    w = v[0] - c[0], v[1] - c[1], v[2] - c[2]
    w = rotate(w, (c[3], c[4], c[5]), rule.cos, rule.sin)
    s = optional(c[6:], 1.0)
    return added_scaled((c[0], c[1], c[2]), s, w)
