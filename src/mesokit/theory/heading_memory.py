"""How much of its heading a lone bird keeps in a step."""

import math

from mesokit.theory._check import dimension_two_or_three


def angular_memory(strength: float, dimension: int) -> float:
    """Mean cosine of the angle by which angular noise turns a heading.

    Parameters: `strength` eta in radians, 0 to 2 pi; `dimension` 2 or 3. In 2D the angle is uniform
    in [-eta/2, eta/2]: sin(eta/2)/(eta/2). In 3D the heading is uniform in a cap of the sphere that
    has the share eta/(2 pi) of it, in which the cosine is uniform in [1 - eta/pi, 1] (Archimedes):
    1 - eta/(2 pi). It is also the polar order of infinitely many birds that all see one another,
    for all then turn from one direction. Raises ValueError for another dimension or strength.
    Source: T. Vicsek et al., Phys. Rev. Lett. 75, 1226 (1995), and H. Chate et al., Phys. Rev. E
    77, 046113 (2008), for the noise.

    >>> round(angular_memory(2.0, 2), 4), round(angular_memory(2.0, 3), 4)
    (0.8415, 0.6817)
    """
    dimension_two_or_three(dimension)
    if not 0 <= strength <= 2 * math.pi:
        raise ValueError(f"strength must be from 0 to 2 pi, got {strength}")
    if dimension == 3:
        return 1.0 - strength / (2 * math.pi)
    return math.sin(0.5 * strength) / (0.5 * strength) if strength > 0 else 1.0


def vectorial_memory(strength: float, dimension: int) -> float:
    """Mean cosine of the angle between u and u + eta xi, xi a random direction.

    Parameters: `strength` eta, 0 to 1; `dimension` 2 or 3. The mean of |r + eta xi| is the
    potential of a sphere (3D: r + eta^2/(3 r)) or a mean over a circle (2D: an elliptic integral),
    and its slope at r = 1 is the mean cosine: 1 - eta^2/3 and (2/pi)(E + (K - E)(1 - eta)/2), with
    the complete elliptic integrals of parameter 4 eta/(1 + eta)^2. Raises ValueError for another
    dimension or strength. Source: derived here; the noise is that of G. Gregoire and H. Chate,
    Phys. Rev. Lett. 92, 025702 (2004).

    >>> round(vectorial_memory(0.5, 2), 4), round(vectorial_memory(0.5, 3), 4)
    (0.9342, 0.9167)
    """
    dimension_two_or_three(dimension)
    if not 0 <= strength <= 1:
        raise ValueError(f"strength must be from 0 to 1, got {strength}")
    if dimension == 3:
        return 1.0 - strength**2 / 3.0
    if strength == 1:
        return 2.0 / math.pi
    from scipy.special import ellipe, ellipk

    parameter = 4.0 * strength / (1.0 + strength) ** 2
    e, k = float(ellipe(parameter)), float(ellipk(parameter))
    return (2.0 / math.pi) * (e + 0.5 * (k - e) * (1.0 - strength))
