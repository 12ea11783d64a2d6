"""Vectorial noise: a bird errs in what it sees of each (Gregoire and Chate 2004)."""

from __future__ import annotations

from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.method.flock.noise.protocol import TURN, Noise, counted, direction, turned, unit_vector
from mesokit.scalar.random import unit, words
from mesokit.scalar.vector import added_scaled
from mesokit.theory.heading_memory import vectorial_memory
from mesokit.theory.polar_order import CrowdOrder, vectorial_order


@component
class VectorialNoise(Noise):
    """Noise is added to the direction of each neighbour: to the sum of the headings of the n birds
    in reach, a vector in a random direction is added that is n times the strength long. The bird
    flies along the sum (Gregoire and Chate, Phys. Rev. Lett. 92, 025702 (2004))."""

    rule: Literal["vectorial"] = tag("vectorial")
    strength: float = param(
        0.5, doc="length of the random vector for each bird", symbol=r"\eta", ge=0, le=1
    )

    def kernel(self) -> Vectorial:
        return Vectorial(self.strength)

    def memory(self, dimension: int) -> float:
        """Of a heading with a random vector of this length added."""
        return vectorial_memory(self.strength, dimension)

    def crowd(self, dimension: int, number: int) -> CrowdOrder:
        """All fly along the mean heading with a random vector of this length added."""
        return vectorial_order(self.strength, number, dimension)


class Vectorial(NamedTuple):
    """Length of the random vector."""

    strength: float


@counted.register(Vectorial)
def _(noise):
    return True


@turned.register(Vectorial)
def _(noise, counter, number, heading, total, around):
    a, b, c, d = words(counter, TURN, number, 0)
    random = unit_vector(heading, unit(a, b), unit(c, d))
    return direction(added_scaled(total, noise.strength * around, random), heading)
