"""The repulsive part of the Lennard-Jones potential."""

from __future__ import annotations

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.potential.lennard_jones import TwelveSix, lorentz_berthelot, twelve_six
from mesokit.potential.protocol import Pair


@component
class WCA(Pair):
    """Lennard-Jones cut off at its minimum 2^(1/6) sigma and shifted: beads that only repel.

    After Weeks, Chandler and Andersen (1971).
    """

    rule: Literal["wca"] = tag("wca")
    epsilon: float = param(1.0, doc="energy at the distance sigma", unit="kT", gt=0, le=1e6)
    sigma: float = param(1.0, doc="diameter of a bead", unit="a", ge=1e-3, le=1e6)

    @property
    def reach(self) -> float:
        return 2.0 ** (1.0 / 6.0) * self.sigma

    @property
    def diameter(self) -> float:
        return self.sigma

    def mixed(self, other: Pair) -> WCA | None:
        """By the rule of Lorentz and Berthelot.

        >>> WCA(epsilon=1, sigma=1).mixed(WCA(epsilon=4, sigma=3))
        WCA(rule='wca', epsilon=2.0, sigma=2.0)
        """
        if not isinstance(other, WCA):
            return None
        return WCA(*lorentz_berthelot((self.epsilon, self.sigma), (other.epsilon, other.sigma)))

    def kernel(self) -> TwelveSix:
        return twelve_six(self.epsilon, self.sigma, 2.0 ** (1.0 / 6.0), True)
