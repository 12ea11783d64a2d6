"""Stochastic rotation dynamics: rotate the velocities of a cell about their mean."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from mesokit import theory
from mesokit.case.component import component, param, show, tag
from mesokit.method.mpcd.collision.protocol import (
    CollisionRule,
    Gas,
    coefficients,
    collide,
    contribute,
    freedom,
)
from mesokit.method.mpcd.collision.rotation import random_axis, rotate
from mesokit.method.mpcd.thermostat.protocol import stretch
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.jit import optional, scalar
from mesokit.scalar.random import unit_open
from mesokit.scalar.vector import added_scaled

ONE = np.uint64(1)
HALF_TURN = "angle = 180: in 2D a half turn keeps the shear stress for ever; expected less than 180"


@component
class SRD(CollisionRule):
    """Rotate relative velocities: in 3D about a random axis, in 2D with a random sign.

    Source: Malevanets and Kapral, J. Chem. Phys. 110, 8605 (1999).
    """

    rule: Literal["srd"] = tag("srd")
    angle: float = param(
        130.0, doc="rotation angle", symbol=r"\alpha", unit="degrees", gt=0, le=180
    )
    angle_distribution: Literal["fixed", "uniform"] = param(
        "fixed", doc="'uniform' draws the angle of each cell from [0, 360), in 2D only"
    )

    conserves: ClassVar[tuple[str, ...]] = ("mass", "momentum", "energy")
    operations: ClassVar[float] = 111.0
    rates: ClassVar[dict[int, float]] = {2: 210.0, 3: 130.0}

    def kernel(self, dimension: int, kT: float) -> SRD2 | SRD2Uniform | SRD3:
        c, s = math.cos(math.radians(self.angle)), math.sin(math.radians(self.angle))
        if dimension == 3:
            return SRD3(c, s)
        return SRD2(c, s) if self.angle_distribution == "fixed" else SRD2Uniform(c)

    def own_sums(self, dimension: int) -> tuple[str, ...]:
        return ()

    def coefficient_count(self, dimension: int, stretched: bool) -> int:
        return 4 if dimension == 2 else 6 + stretched

    def problems(self, dimension: int) -> Iterator[str]:
        if self.angle_distribution == "fixed":
            if self.angle == 180 and dimension == 2:
                yield HALF_TURN
            return
        if dimension == 3:
            yield "angle_distribution = 'uniform': only in 2D; in 3D use rule 'at'"
        if self.angle != SRD().angle:
            yield (
                f"angle = {show(self.angle)}: no effect with angle_distribution = 'uniform'; "
                "leave it out"
            )

    def in_theory(self) -> dict[str, Any]:
        fixed = self.angle_distribution == "fixed"
        return {"rule": "srd", "angle": self.angle if fixed else "uniform"}

    def heat_at_walls(self, gas: Gas) -> theory.HeatAtWalls:
        given = gas._asdict()
        del given["thermostat"]
        return theory.heat_at_walls(**self.in_theory(), **given)

    def bead_diffusion(
        self, gas: Gas, mass: float, others: Sequence[tuple[float, float]] = ()
    ) -> float:
        # the cosine of an angle of 90 degrees is the mean of that of uniform ones
        angle = self.angle if self.angle_distribution == "fixed" else 90.0
        return theory.bead_diffusion(
            "srd", gas.dimension, gas.density, gas.timestep, angle, mass, gas.kT, gas.mass, *others
        )


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


contribute.register(SRD2, SRD2Uniform, SRD3)(lambda rule, counter, key, m, v, r: (v, ()))


freedom.register(SRD2, SRD2Uniform)(lambda rule, n: 2.0 * (n - 1.0))
freedom.register(SRD3)(lambda rule, n: 3.0 * (n - 1.0))


@scalar
def turned_cell(rule, thermostat, variate, cell, cos, sin):
    """Coefficients in 2D: mean velocity, and the rotation times the factor of a thermostat."""
    momentum, share = cell.momentum, 1.0 / cell.mass
    u = momentum[0] * share, momentum[1] * share
    relative = cell.energy - cell.mass * (u[0] * u[0] + u[1] * u[1])
    s = optional(stretch(thermostat, variate, freedom(rule, cell.number), 0.5 * relative), 1.0)
    return u[0], u[1], s * cos, s * sin


@coefficients.register(SRD2)
def _(rule, thermostat, variate, chance, cell):
    sign = 1.0 - 2.0 * float(np.int64(chance[0] & ONE))
    return turned_cell(rule, thermostat, variate, cell, rule.cos, sign * rule.sin)


@coefficients.register(SRD2Uniform)
def _(rule, thermostat, variate, chance, cell):
    sin, cos = sincos_turn(unit_open(chance[0]))
    return turned_cell(rule, thermostat, variate, cell, cos, sin)


@coefficients.register(SRD3)
def _(rule, thermostat, variate, chance, cell):
    momentum, share = cell.momentum, 1.0 / cell.mass
    u = momentum[0] * share, momentum[1] * share, momentum[2] * share
    relative = cell.energy - cell.mass * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2])
    s = stretch(thermostat, variate, freedom(rule, cell.number), 0.5 * relative)
    return u + random_axis(chance[0], chance[1]) + s


@collide.register(SRD2, SRD2Uniform)
def turned_in_plane(rule, c, v, r):
    """The mean velocity plus the relative one times a matrix of rotation and stretch."""
    wx, wy = v[0] - c[0], v[1] - c[1]
    x = mul_add(c[2], wx, mul_add(-c[3], wy, c[0]))
    return x, mul_add(c[3], wx, mul_add(c[2], wy, c[1]))


@collide.register(SRD3)
def _(rule, c, v, r):
    w = v[0] - c[0], v[1] - c[1], v[2] - c[2]
    w = rotate(w, (c[3], c[4], c[5]), rule.cos, rule.sin)
    return added_scaled((c[0], c[1], c[2]), optional(c[6:], 1.0), w)
