"""Heights of an ideal gas under gravity."""

import numpy as np
from numpy.typing import ArrayLike, NDArray


def barometric_cdf(height: ArrayLike, scale: float, depth: float) -> NDArray[np.float64]:
    """Share of the particles below a height: (1 - exp(-z/h))/(1 - exp(-L/h)), h = kT/(m g).

    Parameters: `height` of centres above the lowest that they can reach, in a, heights beyond the
    ends count as at the end; `scale` h in a; `depth` L from the lowest to the highest, in a.

    >>> barometric_cdf([-1.0, 1.0, 9.0], 1.0, 9.0).round(4)
    array([0.    , 0.6322, 1.    ])
    """
    z = np.clip(np.asarray(height, float), 0.0, depth)
    return np.asarray(np.expm1(-z / scale) / np.expm1(-depth / scale))


def barometric_mean(scale: float, depth: float) -> float:
    """Mean height of centres above the lowest they can reach: h - L/(exp(L/h) - 1).

    Parameters: `scale`, `depth` as in `barometric_cdf`.

    >>> round(barometric_mean(2.0, 100.0), 6), round(barometric_mean(1e6, 10.0), 3)
    (2.0, 5.0)
    """
    return float(scale - depth / np.expm1(min(depth / scale, 700.0)))
