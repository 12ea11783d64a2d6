"""Where harmonic traps hold the beads of an ideal molecule, and how they spread about that."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, positive

Array = NDArray[np.floating[Any]]


class TrappedShape(NamedTuple):
    """Mean places (N, d) of beads and their covariance (N, N) along each axis; those of the centre,
    (d,) and one number."""

    mean: Array
    covariance: Array
    centre: Array
    centre_variance: float


def trapped_shape(
    bonds: ArrayLike,
    k: float,
    stiffness: ArrayLike,
    centres: ArrayLike,
    forces: ArrayLike | None = None,
    kT: float = 1.0,
) -> TrappedShape:
    """Mean places and spread of N beads with springs U = k/2 r^2, each in a trap of its own.

    The energy is quadratic, A = k L + diag(stiffness) with the Laplacian L of the bonds, so that
    Boltzmann's distribution is normal: mean A^-1 (stiffness centres + forces), covariance kT A^-1
    along each axis. One bead alone is at a mean square distance of d kT/stiffness from the centre;
    the centre of mass of N beads that are all held alike has the variance kT/(N stiffness) along
    an axis, whatever binds them.

    Parameters:
        bonds: (bonds, 2) numbers of beads from 0, or empty.
        k: stiffness of the bonds; 0 without any.
        stiffness: (N,) that of the trap of each bead, 0 for beads that are not held.
        centres: (N, d) of the traps.
        forces: (N, d) that pull the beads besides (none unless said).
        kT: thermal energy.

    Raises ValueError for numbers out of range and where a bead is held by nothing. Source:
    Boltzmann's distribution of a quadratic energy.

    >>> one = trapped_shape([], 0.0, [5.0], [[10.0, 10.0]])
    >>> one.mean.tolist(), round(float(one.covariance[0, 0]), 6)
    ([[10.0, 10.0]], 0.2)
    >>> dimer = trapped_shape([(0, 1)], 3.0, [2.0, 2.0], [[1.0], [1.0]])
    >>> round(dimer.centre_variance, 6)
    0.25
    """
    positive(kT=kT)
    not_negative(k=k)
    held, where = np.asarray(stiffness, float), np.asarray(centres, float)
    n = len(held)
    pulled = np.zeros_like(where) if forces is None else np.asarray(forces, float)
    if where.ndim != 2 or len(where) != n or pulled.shape != where.shape:
        raise ValueError(
            f"centres, forces: expected ({n}, d) as for stiffness, not {where.shape}, "
            f"{pulled.shape}"
        )
    if (held < 0).any() or not np.isfinite(held).all():
        raise ValueError("stiffness: expected numbers of at least 0")
    matrix = np.diag(held)
    for i, j in np.asarray(bonds, int).reshape(-1, 2):
        matrix[[i, j], [i, j]] += k
        matrix[[i, j], [j, i]] -= k
    if np.linalg.eigvalsh(matrix)[0] <= 1e-12 * max(held.max(), k):
        raise ValueError("stiffness: a bead is held by nothing; expected a trap in each molecule")
    inverse = np.linalg.inv(matrix)
    mean = inverse @ (held[:, None] * where + pulled)
    return TrappedShape(mean, kT * inverse, mean.mean(axis=0), kT * float(inverse.mean()))


def normal_in_box(edges: ArrayLike, mean: float, variance: float, length: float) -> Array:
    """Share of a normal distribution in each bin of a periodic box, (bins,).

    Parameters: `edges` (bins + 1,) from 0 to `length`; `mean` and `variance` of a place that is
    counted as if the box had no bounds. Raises ValueError for a length or variance not above 0.
    Source: sum over all images that matter.

    >>> normal_in_box([0, 5, 10], mean=10.0, variance=0.2, length=10).round(6).tolist()
    [0.5, 0.5]
    """
    from scipy.special import ndtr

    positive(variance=variance, length=length)
    spread, x = variance**0.5, np.asarray(edges, float)
    reach = int(np.ceil(9 * spread / length)) + 1
    images = length * np.arange(-reach, reach + 1)
    below = ndtr((x[:, None] + images - mean % length) / spread).sum(axis=1)
    return np.asarray(np.diff(below))
