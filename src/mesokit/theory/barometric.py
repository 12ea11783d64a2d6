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


def buoyant_scale(mass: float, displaced_mass: float, gravity: float, kT: float = 1.0) -> float:
    """Scale h = kT/((M - M_d) g) of the heights of a body that fluid bears.

    Parameters: `mass` M; `displaced_mass` M_d of the fluid in its volume; `gravity` g, an
    acceleration of fluid and bodies; `kT`. Negative for bodies that rise. Raises ValueError where
    nothing draws it. Source: J. Perrin, Ann. Chim. Phys. 18, 5 (1909).

    >>> round(buoyant_scale(500.0, 400.0, gravity=0.002), 3)
    5.0
    """
    weight = (mass - displaced_mass) * gravity
    if weight == 0:
        raise ValueError("mass, displaced_mass, gravity: expected a weight that is not 0")
    return kT / weight
