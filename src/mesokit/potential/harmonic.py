"""Harmonic bonds, in the two conventions that are in use: they differ by a factor of two."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit import theory
from mesokit.case.component import component, param, tag
from mesokit.potential.protocol import Bond, central


@component
class Harmonic(Bond):
    """U = K r^2: a spring without a length of its own; its mean square is d kT/2K in d dimensions.

    K is half the spring constant of U = k r^2/2, which rule "spring" has.
    """

    rule: Literal["harmonic"] = tag("harmonic")
    K: float = param(doc="U = K r^2", unit="kT/a^2", gt=0, le=1e9)

    @property
    def longest(self) -> float:
        return math.inf

    def kernel(self) -> Square:
        return Square(self.K)

    def spring(self) -> theory.Spring:
        return theory.spring(K=self.K)


@component
class Spring(Bond):
    """U = (k/2) (r - length)^2: a spring about a length of its own (0 unless said)."""

    rule: Literal["spring"] = tag("spring")
    k: float = param(doc="U = (k/2) (r - length)^2", unit="kT/a^2", gt=0, le=1e9)
    length: float = param(0.0, doc="length of the spring at rest", unit="a", ge=0, le=1e6)

    @property
    def longest(self) -> float:
        return math.inf

    def kernel(self) -> AboutLength:
        return AboutLength(self.k, self.length)

    def spring(self) -> theory.Spring | None:
        return theory.spring(k=self.k) if self.length == 0 else None


class Square(NamedTuple):
    """U = K r^2."""

    K: float


class AboutLength(NamedTuple):
    """U = (k/2) (r - length)^2."""

    k: float
    length: float


NO_LENGTH = 1e-12  # below this a bond has no direction, and pulls nowhere


central.register(Square)(lambda potential, square: (potential.K * square, -2.0 * potential.K))


@central.register(AboutLength)
def _(potential, square):
    r = math.sqrt(square)
    beyond = r - potential.length
    return 0.5 * potential.k * beyond * beyond, -potential.k * beyond / max(r, NO_LENGTH)
