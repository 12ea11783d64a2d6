"""Viscosity of a suspension of spheres or disks."""

from mesokit.theory._check import dimension_two_or_three, not_negative, one_of


def suspension_viscosity(
    fraction: float, dimension: int = 3, slip: float = 0.0, order: int = 1
) -> float:
    """Viscosity over that of the fluid, 1 + (d + 2)/2 phi (1 + 2 b/R)/(1 + (d + 2) b/R).

    Einstein's 5/2 of spheres, 2 of disks; the second order adds 6.2 phi^2.

    Parameters: `fraction` phi of the volume that is body; `dimension` d; `slip` length over radius,
    b/R; `order` 1 or 2, the second for Brownian spheres without slip only. Raises ValueError for a
    value out of range. Source: A. Einstein, Ann. Phys. 19, 289 (1906); J. F. Brady, Int. J.
    Multiphase Flow 10, 113 (1984), for disks; G. K. Batchelor, J. Fluid Mech. 83, 97 (1977), for
    the second order. Slip: the strength of the flow about a body in a strain, derived in
    docs/theory.md. Valid for phi below about 0.02, and 0.1 with the second order.

    >>> round(suspension_viscosity(0.02), 3), round(suspension_viscosity(0.02, 2), 3)
    (1.05, 1.04)
    >>> round(suspension_viscosity(0.05, order=2), 4)
    1.1405
    """
    dimension_two_or_three(dimension)
    not_negative(fraction=fraction, slip=slip)
    if fraction >= 1:
        raise ValueError(f"fraction = {fraction!r}: expected a volume fraction below 1")
    one_of((1, 2), order=order)
    stretch = dimension + 2
    first = 1 + stretch / 2 * fraction * (1 + 2 * slip) / (1 + stretch * slip)
    if order == 1:
        return first
    if dimension == 2 or slip:
        raise ValueError("order = 2: known for spheres without slip only")
    return first + 6.2 * fraction**2
