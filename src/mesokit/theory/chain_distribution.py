"""How the sizes of ideal molecules are distributed."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import dimension_two_or_three, positive
from mesokit.theory.normal_modes import NormalModes

Array = NDArray[np.float64]
STEP, LAST = 0.01, 2000.0  # of the integral, in units of one over the mean square


def end_to_end_cdf(distance: ArrayLike, mean_square: float, dimension: int) -> Array:
    """Probability that the ends of an ideal chain are no farther apart than a distance.

    Parameters: `distance`, any shape; `mean_square` end-to-end distance; `dimension` 2 or 3. Raises
    ValueError for a value out of range. Source: the chi distribution, of a Gaussian vector. Exact
    for harmonic bonds without rest length; of others for long chains.

    >>> end_to_end_cdf([0, 2, 100], mean_square=4, dimension=2).round(4).tolist()
    [0.0, 0.6321, 1.0]
    """
    from scipy.special import gammainc

    positive(mean_square=mean_square)
    dimension_two_or_three(dimension)
    r = np.maximum(np.asarray(distance, float), 0.0)
    return np.asarray(gammainc(dimension / 2, dimension * r**2 / (2 * mean_square)))


def gyration_cdf(
    radius: ArrayLike, modes: NormalModes, bond_squared: float, dimension: int
) -> Array:
    """Probability that the radius of gyration of an ideal molecule is no larger than a radius.

    Its square is a sum of squares of Gaussian modes, each with its own variance; the distribution
    of such a sum is the integral of a product over them.

    Parameters: `radius` (n,); `modes` of the molecule; `bond_squared` <b^2> of a free bond;
    `dimension` 2 or 3. Raises ValueError for a value out of range. Source: J. P. Imhof, Biometrika
    48, 419 (1961). Exact for harmonic bonds without rest length; by quadrature, to 1e-4.

    >>> from mesokit.theory import linear_modes
    >>> gyration_cdf([0.5, 1.0, 4.0], linear_modes(3), 1.0, 2).round(3).tolist()
    [0.344, 0.925, 1.0]
    """
    positive(bond_squared=bond_squared)
    dimension_two_or_three(dimension)
    square = np.maximum(np.asarray(radius, float), 0.0) ** 2
    share = 1 / modes.eigenvalues[1:]
    if len(share) == 1:  # the integral falls too slowly, and two beads are known
        return end_to_end_cdf(2 * np.sqrt(square), bond_squared, dimension)
    mean = bond_squared * share.sum() / len(modes.eigenvalues)
    weight = share / share.sum() / dimension
    u = np.arange(STEP / 2, LAST, STEP)
    turned, fallen = np.zeros_like(u), -np.log(u)
    for a in weight:  # dimension squares of normal numbers have this weight
        turned += 0.5 * dimension * np.arctan(a * u)
        fallen -= 0.25 * dimension * np.log1p((a * u) ** 2)
    kept = fallen > fallen.max() - 25  # e^-25: nothing is left
    u, turned, size = u[kept], turned[kept], np.exp(fallen[kept])
    above = [
        0.5 + STEP / np.pi * np.sum(np.sin(turned - 0.5 * x * u) * size) for x in square / mean
    ]
    return np.clip(1 - np.array(above), 0.0, 1.0)


def cosine_cdf(cosine: ArrayLike, dimension: int) -> Array:
    """Probability that a direction drawn at random has no larger cosine with an axis.

    Parameters: `cosine`, any shape, from -1 to 1; `dimension` 2 or 3. Raises ValueError for another
    dimension. Source: the area of a zone of the sphere, the arc of a circle. Exact.

    >>> cosine_cdf([-1, 0.5, 1], 3).tolist(), cosine_cdf([-1, 0.5, 1], 2).round(4).tolist()
    ([0.0, 0.75, 1.0], [0.0, 0.6667, 1.0])
    """
    dimension_two_or_three(dimension)
    c = np.clip(np.asarray(cosine, float), -1.0, 1.0)
    return (1 + c) / 2 if dimension == 3 else 1 - np.arccos(c) / np.pi
