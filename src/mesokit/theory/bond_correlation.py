"""Correlation in time of the bonds of Rouse molecules, at rest and in steady shear."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory.relaxation_modulus import checked_times

Array = NDArray[np.float64]


class BondCorrelation(NamedTuple):
    """<R_a(t) R_b(0)> of a bond vector R, averaged over the bonds of a molecule, t >= 0: flow along
    x, gradient along y. `zz` is that of any other axis, and of all at rest."""

    xx: Array
    yy: Array
    zz: Array
    xy: Array
    yx: Array


def bond_correlation(
    time: ArrayLike,
    stress_times: ArrayLike,
    bond_squared: float,
    shear_rate: float = 0.0,
    dimension: int = 3,
    bonds: int | None = None,
) -> BondCorrelation:
    """Correlations of the bonds of molecules of springs without rest length, in steady shear.

    Each mode decays with its normal-mode time 2 tau_p, and is carried on along x by what
    it has along y: with c = <b^2>/d and e_p = exp(-t/2 tau_p), averaged over modes,
    yy = zz = c e_p, yx = c e_p rate tau_p, xy = c e_p rate (tau_p + t) and
    xx = c e_p (1 + 2 (rate tau_p)^2 + rate^2 tau_p t).

    Parameters
    ----------
    time: 0 or more, any shape.
    stress_times: tau_p, see `rouse_times`.
    bond_squared: <b^2> of a free bond at rest, see `mean_square_bond`.
    shear_rate: of either sign.
    dimension: of space.
    bonds: of a molecule, as many as modes unless said; a ring has one more.

    Raises ValueError for a value out of range. Source: D. Toneian, diploma thesis, TU Wien (2015),
    eqs (6.28) to (6.38), whose upper limit of integration in (6.38) must be min(t, 0); the closed
    form is derived in docs/theory-polymers.md. With hydrodynamic interaction averaged over the
    bonds dimers and trimers have the same modes with other times. Valid as `maxwell_shear`.

    >>> found = bond_correlation(0.0, [10.0], bond_squared=9, shear_rate=0.1)
    >>> float(found.xx + found.yy + found.zz)  # <b^2> (1 + (2/3) (rate tau)^2), as size_in_shear
    15.0
    """
    positive(bond_squared=bond_squared, dimension=dimension)
    tau = checked_times(1.0, stress_times)
    t = np.asarray(time, dtype=float)[..., None]
    if np.any(t < 0):
        raise ValueError(f"time = {time!r}: expected 0 or more")
    count = len(tau) if bonds is None else bonds
    positive(bonds=count)
    kept = bond_squared / dimension / count * np.exp(-t / (2 * tau))
    g = shear_rate * tau
    straight = np.asarray(kept.sum(axis=-1))
    return BondCorrelation(
        np.asarray((kept * (1 + 2 * g**2 + shear_rate * t * g)).sum(axis=-1)),
        straight,
        straight,
        np.asarray((kept * (g + shear_rate * t)).sum(axis=-1)),
        np.asarray((kept * g).sum(axis=-1)),
    )
