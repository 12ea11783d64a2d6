"""Thermostat that gives every cell a kinetic energy from its canonical distribution."""

from __future__ import annotations

from typing import ClassVar, Literal, NamedTuple

from mesokit.case.component import component, tag
from mesokit.method.mpcd.thermostat.protocol import Thermostat, draw, guess, target
from mesokit.scalar.gamma import decided, likely
from mesokit.scalar.random import CELL, CELL_DOUBT, words
from mesokit.theory.transport import Thermostat as Named


@component
class MaxwellBoltzmann(Thermostat):
    """Scale the relative velocities of a cell to an energy drawn from its gamma distribution.

    The mean velocity of the cell is left alone, so that flow is not damped.
    Source: Huang, Chatterji, Sutmann, Gompper and Winkler, J. Comput. Phys. 229, 168 (2010).
    """

    rule: Literal["maxwell-boltzmann"] = tag("maxwell-boltzmann")

    canonical: ClassVar[bool] = True
    in_theory: ClassVar[Named | None] = "maxwell-boltzmann"

    def kernel(self, kT: float, floor: float) -> Canonical:
        return Canonical(kT, floor)


class Canonical(NamedTuple):
    """Thermal energy of the canonical distribution."""

    kT: float
    floor: float


guess.register(Canonical)(lambda thermostat, chance, freedom: likely(chance[0], chance[1], freedom))


@draw.register(Canonical)
def _(thermostat, counter, cell, freedom, attempt):
    """Attempt 0 is the guess."""
    _, _, a, b = words(counter, CELL, cell, attempt)
    c, _, _, _ = words(counter, CELL_DOUBT, cell, attempt)
    return decided(a, b, c, freedom)


target.register(Canonical)(lambda thermostat, variate, freedom, energy: thermostat.kT * variate)
