"""Seam of noises: the turn of a bird, given the sum of the headings around it.

The first argument is the noise's NamedTuple of parameters; its class picks the implementation.
"""

import math
from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.jit import by_type, generic, scalar
from mesokit.scalar.random import METHOD
from mesokit.scalar.vector import dot, scaled
from mesokit.theory.polar_order import CrowdOrder

TURN, FIRST_HEADING = METHOD, METHOD + np.uint64(1)  # purposes of random numbers


@family("noise", "rule", "mesokit.flock_noise")
@component
class Noise(ABC):
    """Noise by which birds fly in other directions than their neighbours."""

    @abstractmethod
    def kernel(self) -> Any:
        """Parameters for the scalar functions below."""

    @abstractmethod
    def memory(self, dimension: int) -> float:
        """Mean cosine of the angle by which a lone bird turns in a step."""

    @abstractmethod
    def crowd(self, dimension: int, number: int) -> CrowdOrder | None:
        """Order of birds that all see one another, None if unknown."""


@generic
def counted(noise):
    """True if `turned` needs the number of birds in reach (a literal)."""


@generic
def turned(noise, counter, number, heading, total, around):
    """The new heading of a bird: a unit vector (d,).

    `heading` is the old one, `total` (d,) the sum of the headings in reach, its own included, and
    what repulsion and cohesion add; `around` is how many birds are in reach.
    """


@scalar
def direction(total, heading):
    """The unit vector along a sum, or the heading where the sum is nothing."""
    square = dot(total, total)
    if square > 0.0:
        return scaled(1.0 / math.sqrt(square), total)
    return heading


@by_type
def unit_vector(pattern, along, around):
    """A direction uniform on the circle or the sphere, from numbers uniform in [0, 1)."""
    if len(pattern) == 2:

        def on_circle(pattern, along, around):
            s, c = sincos_turn(around)
            return c, s

        return on_circle

    def on_sphere(pattern, along, around):
        z = 2.0 * along - 1.0
        s, c = sincos_turn(around)
        r = math.sqrt(1.0 - z * z)
        return r * c, r * s, z

    return on_sphere
