"""Some of many, chosen without chance."""

import numpy as np
from numpy.typing import NDArray


def spread_ids(wanted: int, n: int) -> NDArray[np.int64]:
    """`wanted` ids (or all) spread evenly over 0 .. n - 1.

    >>> spread_ids(3, 9)
    array([0, 3, 6])
    """
    count = min(wanted, n)
    return np.arange(count) * n // max(count, 1)
