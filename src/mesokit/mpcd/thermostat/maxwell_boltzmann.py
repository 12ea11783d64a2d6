"""Thermostat that gives every cell a kinetic energy from its canonical distribution."""

from __future__ import annotations

import math
from typing import ClassVar, Literal, NamedTuple

from mesokit.component import component, tag
from mesokit.elementary import log
from mesokit.mpcd.thermostat.protocol import draw, root_of_ratio, stretch, target
from mesokit.random import CELL_THERMOSTAT, normal_pair, unit_open, words


@component
class MaxwellBoltzmann:
    """Scale the relative velocities of a cell to an energy drawn from its gamma distribution.

    The mean velocity of the cell is left alone, so that flow is not damped.
    Source: Huang, Chatterji, Sutmann, Gompper and Winkler, J. Comput. Phys. 229, 168 (2010).
    """

    rule: Literal["maxwell-boltzmann"] = tag("maxwell-boltzmann")

    needs_energy: ClassVar[bool] = True

    def kernel(self, kT: float) -> Canonical:
        """Parameters for the scalar functions below."""
        return Canonical(kT)


class Canonical(NamedTuple):
    """Thermal energy of the canonical distribution."""

    kT: float


@draw.register(Canonical)
def _(thermostat, counter, cell, attempt, freedom):
    """A number from the gamma distribution of shape freedom / 2 (Marsaglia and Tsang 2000).

    Shape 1/2 (two particles of a rule +a) is half the square of a normal number.
    """
    a, b, c, _ = words(counter, CELL_THERMOSTAT, cell, attempt)
    x, _ = normal_pair(a, b)
    shape = 0.5 * freedom
    large = shape > 0.75
    e = shape - 1.0 / 3.0 if large else 1.0
    t = 1.0 + x / math.sqrt(9.0 * e)
    cube = max(t * t * t, 1e-300)
    accepted = log(unit_open(c)) < 0.5 * x * x + e - e * cube + e * log(cube)
    value = e * cube if large else 0.5 * x * x
    return value if shape > 0.25 else 0.0, accepted or not large


@target.register(Canonical)
def _(thermostat, variate, freedom, energy):
    return thermostat.kT * variate


@stretch.register(Canonical)
def _(thermostat, variate, freedom, energy):
    wanted = target(thermostat, variate, freedom, energy)
    return (root_of_ratio(wanted, energy, freedom),)
