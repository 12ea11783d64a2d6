"""Where the beads of harmonic molecules are in the mean when forces pull at them."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory.normal_modes import NormalModes


def pulled_shape(modes: NormalModes, forces: ArrayLike, K: float) -> NDArray[np.float64]:
    """Mean places of beads about the centre of mass, with springs U = K r^2 and constant forces.

    Parameters: `modes` of the molecule; `forces` (beads, d), which sum to 0; `K` of a spring.
    Raises ValueError for K not above 0, another number of forces, and forces that do not sum to 0
    (the molecule moves then). Source: derived here. The energy K sum (r_i - r_j)^2 - sum f_i r_i is
    quadratic, so that its minimum is the mean: 2 K A r = f with the matrix A of Kirchhoff; spreads
    about it are those without forces. Exact at any temperature. The ends of a chain of N beads
    that are pulled by f and -f are (N - 1) f/(2 K) apart.

    >>> from mesokit.theory import linear_modes, ring_modes
    >>> ends = pulled_shape(linear_modes(3), [[-1.0], [0.0], [1.0]], K=0.5)[[0, -1]]
    >>> ends.round(12).ravel().tolist()
    [-1.0, 1.0]
    >>> held = pulled_shape(ring_modes(4), [[-1.0], [0.0], [1.0], [0.0]], K=0.5)
    >>> round(float(held[2, 0] - held[0, 0]), 12)  # two chains side by side
    1.0
    """
    positive(K=K)
    forces = np.asarray(forces, dtype=float)
    n = len(modes.eigenvalues)
    if forces.ndim != 2 or len(forces) != n:
        raise ValueError(f"forces: expected shape ({n}, d), not {forces.shape}")
    if np.abs(forces.sum(axis=0)).max() > 1e-9 * np.abs(forces).sum():
        raise ValueError("forces: expected a sum of 0")
    vectors = modes.vectors[:, 1:]
    return np.asarray(vectors @ ((vectors.T @ forces) / (2 * K * modes.eigenvalues[1:, None])))
