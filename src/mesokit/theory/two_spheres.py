"""Two spheres that drag each other along: Rotne and Prager, unbounded and in a periodic cube."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive

Array = NDArray[np.float64]
WAVES, IMAGES = 8, 3  # on each side of an axis, of sums that converge to 1e-11


class PairSpeeds(NamedTuple):
    """Speeds of each of two spheres over that of one alone, drawn by equal forces along the line
    between them (`in_line`) or across it (`side_by_side`)."""

    in_line: float
    side_by_side: float


def pair_speeds(radius: float, distance: float) -> PairSpeeds:
    """Speeds 1 + 3x/2 - x^3 - 15x^4/4 + 11x^6/2 + 75x^7/4 in line and 1 + 3x/4 + x^3/2 - 17x^6/16
    side by side, x = R/d.

    The first three terms are those of Rotne and Prager, the rest reflections at the two spheres.

    Parameters: `radius` R of both; `distance` d of their centres. Raises ValueError for a value not
    above 0 and for d below 2 R. Source: J. Rotne and S. Prager, J. Chem. Phys. 50, 4831 (1969); S.
    Kim and S. J. Karrila, Microhydrodynamics (1991), section 11.2. Valid without slip, inertia and
    box; 0.05 % off in line at d = 3 R, where the first three terms alone are 2 % too fast.

    >>> [round(speed, 4) for speed in pair_speeds(1.0, 4.0)]
    [1.3472, 1.1951]
    """
    positive(radius=radius, distance=distance)
    if distance < 2 * radius:
        raise ValueError(f"distance = {distance!r}: expected at least two radii")
    x = radius / distance
    reflected = _reflected(x)
    return PairSpeeds(1 + 1.5 * x - x**3 + reflected[0], 1 + 0.75 * x + 0.5 * x**3 + reflected[1])


def _reflected(x: float) -> tuple[float, float]:
    """Terms beyond Rotne and Prager, along the line and across."""
    return -3.75 * x**4 + 5.5 * x**6 + 18.75 * x**7, -17 / 16 * x**6


def pair_speeds_in_cube(radius: float, distance: float, box_length: float) -> PairSpeeds:
    """The same in a periodic cube, along one of its axes, over the speed 1/(6 pi eta R).

    Parameters: as in `pair_speeds`, and the `box_length` L. Raises ValueError as there and for a
    box below 2 d. Source: `rotne_prager_in_cube`, and reflections as in `pair_speeds`. The
    counter-force is uniform.

    >>> [round(speed, 4) for speed in pair_speeds_in_cube(1.0, 4.0, 30.0)]
    [1.1612, 1.0067]
    """
    pair_speeds(radius, distance)
    if box_length < 2 * distance:
        raise ValueError(f"box_length = {box_length!r}: expected at least two distances")
    own, other = (rotne_prager_in_cube([x, 0.0, 0.0], radius, box_length) for x in (0.0, distance))
    line, across = np.diag(own + other)[:2] + _reflected(radius / distance)
    return PairSpeeds(float(line), float(across))


def rotne_prager_in_cube(separation: ArrayLike, radius: float, box_length: float) -> Array:
    """Mobility (3, 3) of one sphere by a force on another in a periodic cube, times 6 pi eta R.

    The sum over all k = 2 pi n/L but zero of 6 pi R/L^3 (1 - kk/k^2) (sin kR/kR)^2 cos(k.r)/k^2,
    by Ewald's method: images nearby, and waves.

    Parameters: `separation` (3,) r of the centres, zero for the force on the sphere itself;
    `radius` R of both; `box_length` L. Raises ValueError for a value out of range and for overlap.
    Source: J. Rotne and S. Prager, J. Chem. Phys. 50, 4831 (1969); sums: C. W. J. Beenakker, J.
    Chem. Phys. 85, 1581 (1986). On itself this is 1 - 2.8373 R/L + (4 pi/3)(R/L)^3, Hasimoto's
    first three terms. Valid without slip and inertia.

    >>> rotne_prager_in_cube([0.0, 0.0, 0.0], 1.0, 20.0).diagonal().round(6)
    array([0.858659, 0.858659, 0.858659])
    """
    positive(radius=radius, box_length=box_length)
    r = np.asarray(separation, float) / box_length
    if r.shape != (3,):
        raise ValueError(f"separation = {separation!r}: expected 3 numbers")
    r = r - np.rint(r)
    own = not r.any()
    a = radius / box_length
    if not own and np.linalg.norm(r) < 2 * a * (1 - 1e-12):
        raise ValueError(f"separation = {separation!r}: expected none or at least two radii")
    split = math.sqrt(math.pi)  # where both sums are as long
    places = r + _lattice(IMAGES, own)
    waves = 2 * math.pi * _lattice(WAVES, True)
    square = (waves**2).sum(axis=1)
    x = square / (4 * split**2)
    size = 6 * math.pi * (a - a**3 * square / 3) * (1 + x + 2 * x**2) * np.exp(-x) / square
    size *= np.cos(waves @ r)
    total = np.eye(3) * size.sum() - np.einsum("n,ni,nj->ij", size / square, waves, waves)
    total += _nearby(places, a, split)
    if own:
        once = split * a
        total += np.eye(3) * (1 - (6 * once - 40 / 3 * once**3) / math.sqrt(math.pi))
    return np.asarray(total)


def _lattice(reach: int, without_origin: bool) -> Array:
    axis = np.arange(-reach, reach + 1)
    points = np.stack(np.meshgrid(axis, axis, axis), -1).reshape(-1, 3).astype(float)
    return points[points.any(axis=1)] if without_origin else points


def _nearby(places: Array, a: float, split: float) -> Array:
    """Sum over places of what the waves leave out (Beenakker's M1)."""
    from scipy.special import erfc

    r = np.linalg.norm(places, axis=1)
    y, b = split * r, split * a
    near, bell = erfc(y), np.exp(-(y**2)) / math.sqrt(math.pi)
    plain = (0.75 * a / r + 0.5 * (a / r) ** 3) * near
    plain += bell * (b * (3 * y**2 - 4.5) + b**3 * (4 * y**4 - 20 * y**2 + 14 + y**-2))
    along = (0.75 * a / r - 1.5 * (a / r) ** 3) * near
    along += bell * (b * (1.5 - 3 * y**2) + b**3 * (-4 * y**4 + 16 * y**2 - 2 - 3 * y**-2))
    return np.asarray(
        np.eye(3) * plain.sum() + np.einsum("n,ni,nj->ij", along / r**2, places, places)
    )
