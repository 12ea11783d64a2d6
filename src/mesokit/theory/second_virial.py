"""Pressure of dilute gases by the second virial coefficient."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mesokit.theory._check import dimension_two_or_three, positive


def second_virial(
    energy: Callable[[float], float], reach: float, kT: float, dimension: int = 3
) -> float:
    """B2 of a gas whose pressure is n kT (1 + B2 n): -1/2 of the integral of exp(-U/kT) - 1.

    Parameters
    ----------
    energy : callable
        U(r) of a pair; infinite or large where they overlap.
    reach : float
        Distance beyond which U is 0.
    kT : float
        Thermal energy.
    dimension : int
        2 or 3.

    Examples
    --------
    >>> round(second_virial(lambda r: math.inf if r < 1 else 0.0, 1.0, 1.0) / (2 * math.pi / 3), 6)
    1.0
    """
    positive(reach=reach, kT=kT)
    dimension_two_or_three(dimension)
    x, weight = np.polynomial.legendre.leggauss(4000)
    r = 0.5 * reach * (x + 1)
    mayer = np.array([math.expm1(-min(energy(float(one)) / kT, 700.0)) for one in r])
    surface = 2 * math.pi * r if dimension == 2 else 4 * math.pi * r**2
    return float(-0.5 * (0.5 * reach * weight * surface * mayer).sum())
