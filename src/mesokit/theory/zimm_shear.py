"""Short chains in steady shear flow, with hydrodynamic interaction."""

import math
from typing import NamedTuple

import numpy as np

from mesokit.theory._check import not_negative, positive, whole
from mesokit.theory.rouse_times import RouseTimes
from mesokit.theory.zimm_times import bond_mobilities


class ChainInShear(NamedTuple):
    """Mean square length of the bonds in the flow, and the relaxation times of the modes there."""

    bond_squared: float
    times: RouseTimes


def zimm_shear(
    beads: int,
    shear_rate: float,
    spring_constant: float,
    friction: float,
    viscosity: float,
    kT: float = 1.0,
) -> ChainInShear:
    """Chain of n beads with bonds U = K r^2 in shear, hydrodynamics averaged over its bonds there.

    Bonds R obey dR/dt = G R - 2 K B H B^T R + noise, H as in `zimm_times` for bonds of the length l
    that they have in the flow. With the eigenvalues m_p of B H B^T, mode times 1/(2 K m_p) and
    stress times tau_p half of them,

        l^2 = 3 kT/(2 K) [1 + (2/3) mean of (rate tau_p)^2],

    and the stress is that of `maxwell_shear` with these times. For three beads l is that of
    `trimer_bond_length`.

    Parameters:
        beads: n, 2 or more.
        shear_rate: of either sign.
        spring_constant: K of U = K r^2.
        friction: zeta of a bead, kT over its own diffusion coefficient.
        viscosity: eta, dynamic, of the fluid.
        kT: thermal energy.

    Raises ValueError for a value out of range, and for springs so stiff that H is not positive.
    Source: D. Toneian, diploma thesis, TU Wien (2015), chapter 6, for any n derived in
    docs/theory-polymers.md. Valid in 3D for one molecule in a simple fluid.

    >>> chain = zimm_shear(3, 0.1, 1.0, friction=6 * math.pi * 8.7 * 0.3, viscosity=8.7)
    >>> round(math.sqrt(chain.bond_squared), 6)
    1.665299
    """
    whole(2, beads=beads)
    positive(spring_constant=spring_constant, friction=friction, viscosity=viscosity, kT=kT)
    not_negative(shear_rate=abs(shear_rate))
    at_rest = 3 * kT / (2 * spring_constant)

    def stress_times(length: float) -> list[float]:
        mobilities = bond_mobilities(beads, friction, viscosity, length)
        return sorted((1 / (4 * spring_constant * float(m)) for m in mobilities), reverse=True)

    def excess(length: float) -> float:
        times = stress_times(length)
        stretch = sum((shear_rate * tau) ** 2 for tau in times) / len(times)
        return length**2 - at_rest * (1 + 2 / 3 * stretch)

    from scipy.optimize import brentq

    shortest = math.sqrt(at_rest)  # stretched further by any flow, so that H is positive there
    longest = shortest
    while excess(longest) < 0:
        longest *= 2
    root = shortest
    if longest > shortest:
        root = float(brentq(excess, shortest, longest, xtol=1e-14, rtol=1e-14))
    tau = np.array(stress_times(root))
    return ChainInShear(root**2, RouseTimes(2 * tau, tau))
