"""Relaxation times of linear chains with hydrodynamic interaction."""

import math

import numpy as np
from numpy.typing import NDArray

from mesokit.theory._check import positive, whole
from mesokit.theory.rouse_times import RouseTimes


def zimm_times(
    beads: int, friction: float, viscosity: float, bond_length: float, kT: float = 1.0
) -> RouseTimes:
    """Normal-mode and stress times of an ideal chain of n beads, hydrodynamics pre-averaged.

    One over the eigenvalues, but the first, of k H L: k = 3 kT/b^2, L the connectivity matrix,
    mobility H_ii = 1/zeta, H_ij = 1/(eta b sqrt(6 pi^3 |i - j|)).

    Parameters: as in `kirkwood_diffusion`. Raises ValueError for a value out of range, and where H
    is not positive (beads too large for their distance). Source: B. H. Zimm, J. Chem. Phys. 24, 269
    (1956), without his limit of large n; H of D. Toneian, diploma thesis, TU Wien (2015), eq.
    (6.3). Valid for Gaussian chains in a large box. The slowest of long chains
    is 0.4016 eta b^3 n^(3/2)/kT (Doi and Edwards' 1/sqrt(3 pi) = 0.326 holds mode by mode for large
    p, with p^(-3/2)).

    >>> zimm_times(3, friction=50, viscosity=8.7, bond_length=1).mode.round(3).tolist()
    [23.74, 10.336]
    """
    positive(kT=kT)
    mobilities = bond_mobilities(beads, friction, viscosity, bond_length)
    mode = 1 / np.sort(3 * kT / bond_length**2 * mobilities)
    return RouseTimes(mode, mode / 2)


def bond_mobilities(
    beads: int, friction: float, viscosity: float, bond_length: float
) -> NDArray[np.float64]:
    """Eigenvalues (n - 1,) of the mobility of the bonds of a chain, B H B^T; times the spring
    constant they are the rates of its modes.

    Parameters, errors and source as in `zimm_times`.

    >>> bond_mobilities(2, friction=50, viscosity=8.7, bond_length=2).round(5).tolist()
    [0.03157]
    """
    whole(2, beads=beads)
    positive(friction=friction, viscosity=viscosity, bond_length=bond_length)
    apart = np.abs(np.subtract.outer(np.arange(beads), np.arange(beads)))
    scale = viscosity * bond_length * math.sqrt(6 * math.pi**3)
    mobility = np.where(apart == 0, 1 / friction, 1 / (scale * np.sqrt(np.maximum(apart, 1))))
    if not np.linalg.eigvalsh(mobility)[0] > 0:
        raise ValueError(
            f"friction = {friction!r}: expected less for bond_length = {bond_length!r} and "
            f"viscosity = {viscosity!r}, the mobility matrix is not positive"
        )
    # bond vectors have the same rates, without the zero of the centre of mass
    bonds = np.diff(np.eye(beads), axis=0)
    return np.asarray(np.linalg.eigvalsh(bonds @ mobility @ bonds.T))
