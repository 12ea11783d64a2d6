"""Slow flow through a simple cubic array of spheres."""

import math

import numpy as np

from mesokit.theory._check import positive

TOUCHING = math.pi / 6  # concentration at which the spheres touch
# of (c/TOUCHING)^(s/3); Sangani and Acrivos (1982), Table 2
SERIES = [
    1.0, 1.418649, 2.012564, 2.331523, 2.564809, 2.584787, 2.873609, 3.340163, 3.536763,
    3.504092, 3.253622, 2.689757, 2.037769, 1.809341, 1.877347, 1.534685, 0.9034708, 0.2857896,
    -0.5512626, -1.278724, 1.013350, 5.492491, 4.615388, -0.5736023, -2.865924, -4.709215,
    -6.870076, 0.1455304, 12.51891, 9.742811, -5.566269,
]  # fmt: skip
SERIES_ENDS = 0.25  # of c: beyond, it leaves the table
DENSE = ((0.343, 15.4), (0.45, 28.1), (0.5236, 42.1))  # Zick and Homsy (1982), Table 2


def cubic_array_drag(concentration: float) -> float:
    """Force on a sphere over that on a single one in the same flow, K = F/(6 pi eta R U).

    Parameters: `concentration` c, part of the volume that is sphere, 4 pi R^3/(3 L^3). U is the
    superficial velocity (volume flux over the whole cross-section), and F holds all the force that
    drives the flow, rho g L^3: where only the fluid is driven, the sphere itself feels the part
    1 - c of it. Raises ValueError for c not above 0 or above pi/6, where the spheres touch.
    Source: A. S. Sangani and A. Acrivos, Int. J. Multiphase Flow 8, 343 (1982), series of 31 terms,
    for c up to 0.25; beyond, ln K is interpolated between it and the values at c = 0.343, 0.45 and
    0.5236 of A. A. Zick and G. M. Homsy, J. Fluid Mech. 115, 13 (1982). Valid for Reynolds numbers
    well below 1.

    >>> [round(cubic_array_drag(c), 3) for c in (0.001, 0.064, 0.216)]
    [1.212, 2.81, 7.443]
    """
    positive(concentration=concentration)
    if concentration > TOUCHING + 1e-5:  # 0.5236 is what tables print
        raise ValueError(f"concentration = {concentration!r}: expected at most pi/6")
    if concentration <= SERIES_ENDS:
        return _series(concentration)
    c = np.array([SERIES_ENDS, *(c for c, _ in DENSE)])
    log_k = np.log([_series(SERIES_ENDS), *(k for _, k in DENSE)])
    return float(np.exp(np.polyval(np.polyfit(c, log_k, 3), concentration)))


def cubic_array_drag_dilute(concentration: float) -> float:
    """K of a dilute array, 1/(1 - 1.7601 c^(1/3) + c - 1.5593 c^2).

    Parameters, errors and meaning as in `cubic_array_drag`: 0.04 % high at c = 0.027, 6 % at 0.125,
    useless beyond. Source: H. Hasimoto, J. Fluid Mech. 5, 317 (1959).

    >>> round(cubic_array_drag_dilute(0.001), 4)
    1.2121
    """
    positive(concentration=concentration)
    c = concentration
    return 1 / (1 - 1.7601 * c ** (1 / 3) + c - 1.5593 * c**2)


def cubic_array_permeability(concentration: float, pitch: float = 1.0) -> float:
    """Permeability k = nu U/g, L^3/(6 pi R K).

    Parameters: as in `cubic_array_drag`, and the `pitch` L of the array, in cells. Raises
    ValueError as there. Source: Darcy's law with rho g L^3 = F.

    >>> round(cubic_array_permeability(0.064, pitch=10), 3)
    7.608
    """
    positive(pitch=pitch)
    drag = cubic_array_drag(concentration)
    radius = pitch * (3 * concentration / (4 * math.pi)) ** (1 / 3)
    return pitch**3 / (6 * math.pi * radius * drag)


def _series(concentration: float) -> float:
    return float(np.polyval(SERIES[::-1], (concentration / TOUCHING) ** (1 / 3)))
