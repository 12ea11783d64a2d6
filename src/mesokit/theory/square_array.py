"""Slow flow across a square array of cylinders."""

import math

import numpy as np
from numpy.typing import NDArray

from mesokit.theory._check import not_negative, positive

TERMS, POINTS = 28, 112  # of the series, and on each side of the cell: 1e-3 at c = 0.7, then worse
DENSEST = 0.7
Array = NDArray[np.float64]


def square_array_drag(concentration: float, slip: float = 0.0) -> float:
    """Force F on a cylinder for each length, over eta U: F/(eta U).

    Parameters: `concentration` c, part of the volume that is cylinder, pi R^2/L^2. U is the
    superficial velocity (volume flux over the whole cross-section, cylinders included), and F holds
    all the force that drives the flow, rho g L^2: where only the fluid is driven, the cylinder
    itself feels the part 1 - c of it. `slip` b/R, slip length over radius. Raises ValueError for c
    not above 0 or above 0.7, and for b below 0. Source: A. S. Sangani and A. Acrivos, Int. J.
    Multiphase Flow 8, 193 (1982), Table 1, whose values (no slip, c from 0.05 to 0.7) this gives to
    all their digits: the stream function is the series of solutions of the biharmonic equation that
    obey the surface of the cylinder, fitted to the symmetry of the flow at the edge of the cell.
    Valid for Reynolds numbers well below 1.

    >>> [round(square_array_drag(c), 2) for c in (0.05, 0.2, 0.5)]
    [15.56, 51.53, 532.55]
    """
    positive(concentration=concentration)
    not_negative(slip=slip)
    if concentration > DENSEST:
        raise ValueError(f"concentration = {concentration!r}: expected at most {DENSEST}")
    edge = 0.5 * math.sqrt(math.pi / concentration)  # half the pitch, over the radius
    along = edge * (np.arange(POINTS) + 0.5) / POINTS
    columns = []
    # Two stream functions for each odd n, by the symmetry of the flow. A column has stream
    # function, vorticity or their slopes at points of two edges of the cell. The series is fitted
    # to their values there.
    for n in range(1, 2 * TERMS, 2):
        for powers, logarithm in _at_surface(n, slip):
            top = _flow(n, powers, logarithm, along, np.full(POINTS, edge))
            side = _flow(n, powers, logarithm, np.full(POINTS, edge), along)
            # no flow and no shear across the top; the flow leaves the side straight
            columns.append(np.concatenate([top[0], top[2], side[1], side[3]]))
    basis = np.stack(columns, axis=1)
    wanted = np.zeros(len(basis))
    wanted[:POINTS] = edge  # U = 1
    size = abs(basis).max(axis=0)
    found = np.linalg.lstsq(basis / size, wanted, rcond=1e-14)[0] / size
    return float(4 * math.pi * found[0])  # that of r ln r sin(theta)


def square_array_drag_dilute(concentration: float) -> float:
    """F/(eta U) of a dilute array, 4 pi/(ln c^(-1/2) - 0.738 + c - 0.887 c^2 + 2.038 c^3).

    Parameters, errors and meaning as in `square_array_drag`, which it approaches for small c: 0.1 %
    low at c = 0.1, 1.5 % at 0.2. Source: Sangani and Acrivos (1982), eq. (54).

    >>> round(square_array_drag_dilute(0.05), 2)
    15.55
    """
    positive(concentration=concentration)
    c = concentration
    below = -0.5 * math.log(c) - 0.738 + c - 0.887 * c**2 + 2.038 * c**3
    return 4 * math.pi / below


def square_array_permeability(concentration: float, pitch: float = 1.0) -> float:
    """Permeability k = nu U/g, L^2 eta U/F.

    Parameters: as in `square_array_drag`, and the `pitch` L of the array, in cells. Raises
    ValueError as there. Source: Darcy's law with rho g L^2 = F.

    >>> round(square_array_permeability(0.2, pitch=10), 4)
    1.9407
    """
    positive(pitch=pitch)
    return pitch**2 / square_array_drag(concentration)


Powers = list[tuple[float, int]]  # (coefficient, power) of r


def _at_surface(n: int, slip: float) -> list[tuple[Powers, float]]:
    """Radial parts of the two stream functions of sin(n theta) that obey the surface r = 1, and
    their coefficient of r ln r.

    The value f vanishes, and the slip f'(1 + b) - b f''; r^n and r^-n make them do so.
    """
    stretch = 2 * n * (1 + 2 * slip)
    pairs: list[tuple[Powers, float]] = []
    if n == 1:
        pairs.append(([(-1 / stretch, 1), (1 / stretch, -1)], 1.0))
    for power in (n + 2, 2 - n)[: 2 - len(pairs)]:
        slipped = power * (1 + 2 * slip - slip * power) + n * (1 + 2 * slip + slip * n)
        grows = -slipped / stretch
        pairs.append(([(1.0, power), (grows, n), (-1 - grows, -n)], 0.0))
    return pairs


def _flow(n: int, powers: Powers, logarithm: float, x: Array, y: Array) -> list[Array]:
    """Stream function, its slope along x, vorticity, and the slope of that along x."""
    r, angle = np.hypot(x, y), np.arctan2(y, x)
    whirls = [(c * (p * p - n * n), p - 2) for c, p in powers]
    log, sine, cosine = np.log(r), np.sin(n * angle), np.cos(n * angle)
    out = []
    for terms, more, more_slope in (
        (powers, logarithm * r * log, logarithm * (log + 1)),
        (whirls, logarithm * 2 / r, -logarithm * 2 / r**2),
    ):
        value = sum(c * r ** float(p) for c, p in terms) + more
        slope = sum(c * p * r ** float(p - 1) for c, p in terms) + more_slope
        out += [value * sine, slope * sine * x / r - value * n * cosine * y / r**2]
    return out
