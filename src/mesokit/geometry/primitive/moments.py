"""Volume, centre and second moments of a primitive of uniform density."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Integrals(NamedTuple):
    """Volume (area in 2D), centre (3,), and integrals of x_i x_j about the centre (3, 3)."""

    volume: float
    centre: NDArray[np.float64]
    second: NDArray[np.float64]


def plane(d: int) -> NDArray[np.float64]:
    """1 for each axis of the box, on the diagonal."""
    return np.diag([1.0, 1.0, 1.0 if d == 3 else 0.0])
