"""Diffusion of the centre of mass of chains, with and without hydrodynamic interaction."""

import math

import numpy as np

from mesokit.theory._check import positive, whole


def rouse_diffusion(beads: int, friction: float, kT: float = 1.0) -> float:
    """Diffusion coefficient kT/(n zeta) of a molecule of n beads that drag nothing along.

    Parameters: `beads` n; `friction` zeta of one, kT over its own diffusion coefficient; `kT`.
    Raises ValueError for a value out of range. Source: P. E. Rouse, J. Chem. Phys. 21, 1272 (1953).
    Valid for any bonds and topology.

    >>> rouse_diffusion(10, friction=4)
    0.025
    """
    whole(1, beads=beads)
    positive(friction=friction, kT=kT)
    return kT / (beads * friction)


def kirkwood_diffusion(
    beads: int, friction: float, viscosity: float, bond_length: float, kT: float = 1.0
) -> float:
    """Diffusion coefficient of an ideal linear chain of n beads with hydrodynamic interaction.

    kT/(n zeta) + kT/(n^2 eta b sqrt(6 pi^3)) sum_{i != j} |i - j|^(-1/2).

    Parameters: `beads` n; `friction` zeta of one; `viscosity` eta, dynamic; `bond_length` b,
    root-mean-square; `kT`. Raises ValueError for a value out of range. Source: J. G. Kirkwood and
    J. Riseman, J. Chem. Phys. 16, 565 (1948), with Gaussian distances, as in H of D. Toneian,
    diploma thesis, TU Wien (2015), eq. (6.3). Valid for Gaussian chains in a large box (see
    `diffusion_in_box`); a little high, as shapes are averaged before they move.

    >>> round(kirkwood_diffusion(10, friction=50, viscosity=8.7, bond_length=1), 6)
    0.006676
    """
    positive(viscosity=viscosity, bond_length=bond_length)
    apart = np.arange(1, beads)
    pairs = 2 * float(((beads - apart) / np.sqrt(apart)).sum())
    drag = beads**2 * viscosity * bond_length * math.sqrt(6 * math.pi**3)
    return rouse_diffusion(beads, friction, kT) + kT * pairs / drag


def kirkwood_in_cells(
    beads: int, friction: float, viscosity: float, bond_length: float, kT: float = 1.0
) -> float:
    """Diffusion coefficient of an ideal chain of n beads, or of one, in MPCD with cells of side 1.

    kT/(n zeta) + kT/(n^2 eta sqrt(6 pi^3)) sum_ij (|i - j| b^2 + 1)^(-1/2), i = j as well. A bead
    hands its momentum to a cell that lies anywhere around it, and takes the velocity of such a
    cell: this adds four numbers uniform in [-1/2, 1/2] to each component of a distance, of variance
    1/3 together.

    Parameters: as in `kirkwood_diffusion`, but `friction` is that of a bead in a fluid without
    memory (kT over `bead_diffusion`); what one bead drags along is in the sum. Raises
    ValueError for a value out of range. Source: derived here. Valid for Gaussian chains and
    monomers in a large box (see `diffusion_in_box`), with the full grid shift.

    >>> round(kirkwood_in_cells(1, friction=72.77, viscosity=8.695, bond_length=1), 5)
    0.02217
    """
    positive(viscosity=viscosity, bond_length=bond_length)
    apart = np.arange(1, beads)
    pairs = beads + 2 * float(((beads - apart) / np.sqrt(apart * bond_length**2 + 1)).sum())
    drag = beads**2 * viscosity * math.sqrt(6 * math.pi**3)
    return rouse_diffusion(beads, friction, kT) + kT * pairs / drag


def zimm_diffusion(beads: int, viscosity: float, bond_length: float, kT: float = 1.0) -> float:
    """Diffusion coefficient 8 kT/(3 sqrt(6 pi^3) eta b sqrt n) of a long ideal chain.

    Parameters, errors as in `kirkwood_diffusion`, whose limit of large n it is. Source: B. H. Zimm,
    J. Chem. Phys. 24, 269 (1956). Good at any n for beads of hydrodynamic radius b/4; for b/10 16 %
    low at n = 60: compare short chains with `kirkwood_diffusion`.

    >>> round(zimm_diffusion(100, viscosity=8.7, bond_length=1), 6)
    0.002247
    """
    whole(1, beads=beads)
    positive(viscosity=viscosity, bond_length=bond_length, kT=kT)
    drag = 3 * math.sqrt(6 * math.pi**3) * viscosity * bond_length * math.sqrt(beads)
    return 8 * kT / drag
