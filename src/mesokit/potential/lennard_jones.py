"""The Lennard-Jones potential with a cut-off."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

from mesokit.case.component import component, param, tag
from mesokit.potential.protocol import Pair, central


@component
class LennardJones(Pair):
    """U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6) up to the cut-off, shifted to 0 there."""

    rule: Literal["lennard-jones"] = tag("lennard-jones")
    epsilon: float = param(1.0, doc="depth of the well", unit="kT", gt=0, le=1e6)
    sigma: float = param(1.0, doc="distance of zero energy", unit="a", ge=1e-3, le=1e6)
    cutoff: float = param(2.5, doc="no force beyond, in units of sigma", unit="sigma", ge=1, le=1e3)
    shift: bool = param(True, doc="whether the energy is shifted to 0 at the cut-off")

    @property
    def reach(self) -> float:
        return self.cutoff * self.sigma

    @property
    def diameter(self) -> float:
        return self.sigma

    def mixed(self, other: Pair) -> LennardJones | None:
        """By the rule of Lorentz and Berthelot, where both are cut off in the same way."""
        if not isinstance(other, LennardJones):
            return None
        if (self.cutoff, self.shift) != (other.cutoff, other.shift):
            return None
        both = lorentz_berthelot((self.epsilon, self.sigma), (other.epsilon, other.sigma))
        return LennardJones(*both, self.cutoff, self.shift)

    def kernel(self) -> TwelveSix:
        return twelve_six(self.epsilon, self.sigma, self.cutoff, self.shift)


class TwelveSix(NamedTuple):
    """4 epsilon, squares of sigma and of the cut-off, and the energy added."""

    four: float
    square: float
    limit: float
    lift: float


def twelve_six(epsilon: float, sigma: float, cutoff: float, shift: bool) -> TwelveSix:
    """Parameters; the cut-off is in units of sigma."""
    sixth = cutoff**-6
    at_cutoff = 4.0 * epsilon * (sixth * sixth - sixth)
    return TwelveSix(4.0 * epsilon, sigma**2, (cutoff * sigma) ** 2, -at_cutoff if shift else 0.0)


def lorentz_berthelot(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    """Energy and diameter between two kinds of beads, from those of each: the geometric mean of
    the energies (Berthelot 1898), the arithmetic mean of the diameters (Lorentz 1881).

    >>> lorentz_berthelot((1.0, 1.0), (4.0, 3.0))
    (2.0, 2.0)
    """
    return math.sqrt(one[0] * other[0]), 0.5 * (one[1] + other[1])


CLOSEST = 1e-3  # of sigma^2: nearer, the force grows no more


@central.register(TwelveSix)
def _(potential, square):
    inverse = potential.square / max(square, CLOSEST * potential.square)
    sixth = inverse * inverse * inverse
    energy = potential.four * sixth * (sixth - 1.0) + potential.lift
    force_over_r = 6.0 * potential.four * sixth * (2.0 * sixth - 1.0) * inverse / potential.square
    near = square < potential.limit
    return (energy if near else 0.0), (force_over_r if near else 0.0)
