"""Structure factor of one ideal molecule: Debye's sum over its beads."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, positive, whole

Array = NDArray[np.float64]


def gaussian_structure_factor(
    wavenumber: ArrayLike,
    bonds: Sequence[Sequence[int]],
    bond_squared: float,
    dimension: int = 3,
    beads: int | None = None,
) -> Array:
    """(1/n) sum_ij exp(-q^2 <r_ij^2>/(2 d)) of a molecule of n beads linked by springs.

    n for long waves, 1 for short ones; the form factor is 1/n of it. <r_ij^2> is <b^2> |i - j| in
    a chain, and in any network <b^2> times the resistance between i and j if each spring were a
    resistor of 1.

    Parameters
    ----------
    wavenumber: q, any shape.
    bonds: pairs of beads, from 0, that link all of them.
    bond_squared: <b^2> of a free bond, see `mean_square_bond`.
    dimension: of space.
    beads: n, one more than the largest number in `bonds` unless said.

    Raises ValueError for a value out of range, and for bonds that leave several pieces. Source:
    P. Debye, J. Phys. Colloid Chem. 51, 18 (1947), here of a finite number of beads. Valid for
    springs without rest length, and no other potentials.

    >>> chain = [(0, 1), (1, 2)]
    >>> gaussian_structure_factor([0.0, 50.0], chain, 1.5).tolist()
    [3.0, 1.0]
    >>> x = np.exp(-1.5 / 6)  # q = 1
    >>> bool(np.isclose(gaussian_structure_factor(1.0, chain, 1.5), (3 + 4 * x + 2 * x**2) / 3))
    True
    """
    positive(bond_squared=bond_squared)
    dimension_two_or_three(dimension)
    n = (1 + max((max(pair) for pair in bonds), default=0)) if beads is None else beads
    whole(1, beads=n)
    square, times = np.unique(np.round(_resistances(bonds, n), 9), return_counts=True)
    q = np.asarray(wavenumber, float)[..., None]
    each = np.exp(-(q**2) * square * bond_squared / (2 * dimension))
    return np.asarray((each * times).sum(axis=-1) / n)


def _resistances(bonds: Sequence[Sequence[int]], beads: int) -> Array:
    """Between each two beads, (n, n), if each bond were a resistor of 1."""
    links = np.zeros((beads, beads))
    for i, j in bonds:
        links[[i, j], [i, j]] += 1.0
        links[[i, j], [j, i]] -= 1.0
    green = np.zeros((beads, beads))
    try:
        green[1:, 1:] = np.linalg.inv(links[1:, 1:])  # the first bead is held
    except np.linalg.LinAlgError:
        raise ValueError(f"bonds = {bonds!r}: expected to link all {beads} beads") from None
    own = np.diag(green)
    return np.asarray(own[:, None] + own - 2 * green)
