"""Flow between two round surfaces with the same axis that turn."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive


def taylor_couette_coefficients(
    inner: float, outer: float, inner_rate: float, outer_rate: float
) -> tuple[float, float]:
    """A and B of the azimuthal velocity A r + B/r.

    Parameters: `inner`, `outer` radii of the surfaces, in cells; `inner_rate`, `outer_rate` at
    which they turn, in radians. Raises ValueError for radii not above 0, `outer` not above `inner`.
    Source: Landau and Lifshitz, Fluid Mechanics, Sec. 18: A = (R2^2 w2 - R1^2 w1)/(R2^2 - R1^2),
    B = (w1 - w2) R1^2 R2^2/(R2^2 - R1^2).

    >>> taylor_couette_coefficients(1, 2, 0.3, 0.3)  # turning as one: no shear
    (0.3, 0.0)
    """
    positive(inner=inner, outer=outer)
    if not outer > inner:
        raise ValueError(f"outer = {outer!r}: expected more than inner = {inner!r}")
    gap = outer**2 - inner**2
    a = (outer**2 * outer_rate - inner**2 * inner_rate) / gap
    b = (inner_rate - outer_rate) * inner**2 * outer**2 / gap
    return a, b


def taylor_couette_velocity(
    r: ArrayLike, inner: float, outer: float, inner_rate: float, outer_rate: float
) -> NDArray[np.float64]:
    """Azimuthal velocity A r + B/r at the distance r from the axis.

    Parameters: `r` any shape, in [inner, outer]; the others, errors and source as in
    `taylor_couette_coefficients`. Valid below the onset of vortices (3D: inner surface turning,
    Taylor number above 1708; 2D has none), velocities well below the speed of sound.

    >>> taylor_couette_velocity([1, 2], 1, 2, 0.3, 0.0).round(12).tolist()
    [0.3, 0.0]
    """
    a, b = taylor_couette_coefficients(inner, outer, inner_rate, outer_rate)
    r = np.asarray(r, dtype=float)
    return np.asarray(a * r + b / r)


def taylor_couette_torque(
    inner: float,
    outer: float,
    inner_rate: float,
    outer_rate: float,
    dynamic_viscosity: float,
    one_sided: float = 0.0,
) -> tuple[float, float]:
    """Torque of the fluid on the inner and on the outer surface, per length of the axis.

    Parameters: as in `taylor_couette_coefficients`; `dynamic_viscosity` eta; `one_sided`, the part
    eta' of it by which momentum crosses a plane in proportion to du/dr alone, instead of r
    d(u/r)/dr: that of collisions that do not conserve angular momentum, 0 for those that do.
    Raises ValueError as there, and for a viscosity not above 0.
    Source: Landau and Lifshitz, Fluid Mechanics, Sec. 18, -4 pi eta B on the inner surface; the
    one-sided part adds 2 pi eta' R^2 w on each (inner +, outer -): Gotze, Noguchi and Gompper,
    Phys. Rev. E 76, 046705 (2007). It vanishes on a surface at rest, and drags on rigid rotation.

    >>> inner, outer = taylor_couette_torque(1, 2, 0.0, 0.3, 0.5)
    >>> round(inner, 6), round(outer, 6)
    (2.513274, -2.513274)
    """
    positive(dynamic_viscosity=dynamic_viscosity)
    _, b = taylor_couette_coefficients(inner, outer, inner_rate, outer_rate)
    shear = -4 * math.pi * dynamic_viscosity * b
    spin = 2 * math.pi * one_sided
    return shear + spin * inner**2 * inner_rate, -shear - spin * outer**2 * outer_rate
