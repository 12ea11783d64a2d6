"""Normal modes of beads that are linked by equal springs."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.theory._check import whole

Array = NDArray[np.float64]


class NormalModes(NamedTuple):
    """Modes of the connectivity matrix: each bead's number of bonds, minus 1 for each neighbour.

    `eigenvalues` (n,) rise from 0, that of the centre of mass. `vectors` (n, n): column p is mode
    p, of unit length, so that X_p = sum_i vectors[i, p] r_i and k eigenvalues[p] is its stiffness.
    """

    eigenvalues: Array
    vectors: Array


def linear_modes(beads: int) -> NormalModes:
    """Modes of a linear chain: 4 sin^2(p pi/2n), sqrt((2 - [p = 0])/n) cos(p pi (i + 1/2)/n).

    Parameters: `beads` n, from 0 along the chain. Raises ValueError for fewer than 2. Source:
    P. E. Rouse, J. Chem. Phys. 21, 1272 (1953). Exact for any n.

    >>> linear_modes(3).eigenvalues.round(12).tolist()
    [0.0, 1.0, 3.0]
    """
    whole(2, beads=beads)
    p, i = np.arange(beads), np.arange(beads)[:, None]
    vectors = np.sqrt(np.where(p == 0, 1, 2) / beads) * np.cos(np.pi * p * (i + 0.5) / beads)
    return NormalModes(4 * np.sin(np.pi * p / (2 * beads)) ** 2, vectors)


def ring_modes(beads: int) -> NormalModes:
    """Modes of a ring: 4 sin^2(q pi/n), each but the first (and the last, n even) twice.

    Of each pair the first is a cosine of the bead's number, 1 at bead 0, the second a sine.
    Parameters: `beads` n, in order. Raises ValueError for fewer than 3. Source: V. A. Bloomfield
    and B. H. Zimm, J. Chem. Phys. 44, 315 (1966). Exact for any n.

    >>> ring_modes(4).eigenvalues.round(12).tolist()
    [0.0, 2.0, 2.0, 4.0]
    """
    whole(3, beads=beads)
    p, i = np.arange(beads), np.arange(beads)[:, None]
    q = (p + 1) // 2
    phase = 2 * np.pi * q * i / beads
    alone = (q == 0) | (2 * q == beads)
    vectors = np.sqrt(np.where(alone, 1, 2) / beads) * np.where(
        (p % 2 == 1) | (q == 0), np.cos(phase), np.sin(phase)
    )
    return NormalModes(4 * np.sin(np.pi * q / beads) ** 2, vectors)


def star_modes(arms: int, arm_beads: int) -> NormalModes:
    """Modes of a star: bead 0 in the middle, then the beads of each arm from the inside out.

    Parameters: `arms` f and `arm_beads` n in each. Raises ValueError for fewer than 1. Source: B.
    H. Zimm and R. W. Kilb, J. Polym. Sci. 37, 19 (1959): 4 sin^2((2q - 1) pi/(4n + 2)), f - 1 times
    each, where the middle rests, and 4 sin^2(x/2) with sin (n + 1)x = -(f - 1) sin n x where all
    arms do the same. Diagonalised numerically, to rounding.

    >>> star_modes(3, 1).eigenvalues.round(12).tolist()
    [0.0, 1.0, 1.0, 4.0]
    """
    whole(1, arms=arms, arm_beads=arm_beads)
    beads = 1 + arms * arm_beads
    outer = range(1, beads)
    return network_modes([(0 if (b - 1) % arm_beads == 0 else b - 1, b) for b in outer], beads)


def network_modes(bonds: Iterable[Sequence[int]], beads: int) -> NormalModes:
    """Modes of any beads that hang together: networks, dendrimers.

    Parameters: `bonds`, pairs of beads from 0; `beads` n. Raises ValueError for fewer than 2 beads
    and for bonds that leave several pieces. Source: B. E. Eichinger, Macromolecules 13, 1 (1980):
    the matrix of Kirchhoff, diagonalised numerically, to rounding.

    >>> network_modes([(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)], 4).eigenvalues.round(12).tolist()
    [0.0, 2.0, 4.0, 4.0]
    """
    whole(2, beads=beads)
    matrix = np.zeros((beads, beads))
    for one, other in bonds:
        matrix[[one, other], [one, other]] += 1
        matrix[[one, other], [other, one]] -= 1
    eigenvalues, vectors = np.linalg.eigh(matrix)
    if eigenvalues[1] < 1e-9 * eigenvalues[-1]:
        raise ValueError("bonds: expected beads that hang together")
    eigenvalues[0] = 0  # exactly: the centre of mass
    return NormalModes(eigenvalues, vectors)
