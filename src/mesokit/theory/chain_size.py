"""Size of ideal chains in equilibrium: end-to-end distance and radius of gyration."""

import numpy as np

from mesokit.theory._check import positive, whole
from mesokit.theory.normal_modes import NormalModes


def mean_square_end_to_end(beads: int, bond_squared: float) -> float:
    """Mean square end-to-end distance (n - 1) <b^2> of a linear chain.

    Parameters: `beads` n; `bond_squared` <b^2>, see `mean_square_bond`. Raises ValueError for a
    value out of range. Source: bonds that point independently. Valid for any such bonds without
    excluded volume and bending.

    >>> mean_square_end_to_end(10, 1.5)
    13.5
    """
    whole(2, beads=beads)
    positive(bond_squared=bond_squared)
    return (beads - 1) * bond_squared


def mean_square_gyration(modes: NormalModes, bond_squared: float) -> float:
    """Mean square radius of gyration <b^2>/n sum_p 1/eigenvalue_p of any ideal molecule.

    <b^2> (n^2 - 1)/(6 n) of a linear chain, half of it of a ring.

    Parameters: `modes` of the molecule; `bond_squared` <b^2> of a free bond. Raises ValueError for
    a value not above 0. Source: B. E. Eichinger, Macromolecules 13, 1 (1980). Valid as
    `mean_square_end_to_end` for molecules without rings, and for rings of bonds without rest
    length.

    >>> from mesokit.theory import linear_modes, ring_modes
    >>> round(mean_square_gyration(linear_modes(10), 1.5), 9)
    2.475
    >>> round(mean_square_gyration(ring_modes(10), 1.5), 9)
    1.2375
    """
    positive(bond_squared=bond_squared)
    return bond_squared * float(np.sum(1 / modes.eigenvalues[1:])) / len(modes.eigenvalues)
