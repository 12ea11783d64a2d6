"""Thermostat that gives every cell a kinetic energy from its canonical distribution."""

from __future__ import annotations

import math
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from mesokit.component import component, tag
from mesokit.elementary import log
from mesokit.mpcd.thermostat.protocol import draw, guess, root_of_ratio, stretch, target
from mesokit.random import CELL, CELL_DOUBT, normal, unit_open, words
from mesokit.scalar import mul_add, scalar

LAST_BITS = np.uint64(4095)


@component
class MaxwellBoltzmann:
    """Scale the relative velocities of a cell to an energy drawn from its gamma distribution.

    The mean velocity of the cell is left alone, so that flow is not damped.
    Source: Huang, Chatterji, Sutmann, Gompper and Winkler, J. Comput. Phys. 229, 168 (2010).
    """

    rule: Literal["maxwell-boltzmann"] = tag("maxwell-boltzmann")

    needs_energy: ClassVar[bool] = True

    def kernel(self, kT: float, floor: float) -> Canonical:
        """Parameters for the scalar functions below; an energy below the floor is noise."""
        return Canonical(kT, floor)


class Canonical(NamedTuple):
    """Thermal energy of the canonical distribution."""

    kT: float
    floor: float


@scalar
def propose(chance, freedom):
    """A candidate for a gamma variate of shape freedom / 2 (Marsaglia and Tsang 2000, section 2).

    Gives the candidate and what decides on it: the normal number x, e, 1 / sqrt(9 e), and
    t = 1 + x / sqrt(9 e). Shape 1/2 (two particles of a rule +a) is half the square of x, to be
    taken as it is; e is then 0.
    """
    x = normal(chance[0], chance[1])
    shape = 0.5 * freedom
    large = shape > 0.75
    e = shape - 1.0 / 3.0 if large else 1.0
    width = 1.0 / math.sqrt(9.0 * e)
    t = mul_add(x, width, 1.0)
    small = 0.5 * x * x if shape > 0.25 else 0.0
    return e * (t * t * t) if large else small, x, e if large else 0.0, width, t


@scalar
def part(chance):
    """Which of 4096 equal parts of (0, 1) the number u of the test lies in.

    These bits of a word are also the last ones of x, where they move it by less than 1e-5.
    """
    return float(np.int64(chance[1] & LAST_BITS))


@guess.register(Canonical)
def _(thermostat, chance, freedom):
    """Sure where all of u's part is below a bound on what the test compares it to.

    The test is log u < f, where with y = x / sqrt(9 e) f is -e times the integral of
    3 s^3 / (1 + s) from 0 to y; for y > -1/2 it is at least -z, z = 3/4 e y^4 max(1, 1 - 2 y), as
    1 / (1 + y) < 1 - 2 y for negative y. And log u < -z where u < 1 - z.
    """
    value, x, e, width, t = propose(chance, freedom)
    square = x * x * width
    z = square * square * max(3.0 - 2.0 * t, 1.0) / 12.0
    below = 4096.0 * (1.0 - z)
    return value, (t > 0.5 and part(chance) + 1.0 < below) or e == 0.0


@draw.register(Canonical)
def _(thermostat, counter, cell, freedom, attempt):
    """Attempt 0 is the guess; within its part, u is drawn now."""
    _, _, a, b = words(counter, CELL, cell, attempt)
    c, _, _, _ = words(counter, CELL_DOUBT, cell, attempt)
    value, x, e, _, t = propose((a, b), freedom)
    u = (part((a, b)) + unit_open(c)) / 4096.0
    cube = max(t * t * t, 1e-300)
    accepted = t > 0.0 and log(u) < 0.5 * x * x + e - e * cube + e * log(cube)
    return value, accepted or e == 0.0


@target.register(Canonical)
def _(thermostat, variate, freedom, energy):
    return thermostat.kT * variate


@stretch.register(Canonical)
def _(thermostat, variate, freedom, energy):
    wanted = target(thermostat, variate, freedom, energy)
    return (root_of_ratio(wanted, energy, freedom, thermostat.floor),)
