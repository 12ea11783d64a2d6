"""Areas of disks and volumes of spheres that planes across the axes cut off."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.seam.engine import Array

NODES, WEIGHTS = np.polynomial.legendre.leggauss(32)


def below(height: ArrayLike, radius: ArrayLike, dimension: int) -> Array:
    """Area of a disk, or volume of a sphere, that lies below a plane so high above its centre.

    >>> np.round(below([-2.0, 0.0, 2.0], 1.0, 2) / math.pi, 12)
    array([0. , 0.5, 1. ])
    >>> round(float(below(0.5, 1.0, 3)) / math.pi, 12)  # all but a cap of height 1/2
    1.125
    """
    t = np.clip(np.asarray(height) / radius, -1.0, 1.0)
    if dimension == 2:
        part = 0.5 * math.pi + np.arcsin(t) + t * np.sqrt(1 - t * t)
    else:
        part = math.pi * (2 / 3 + t - t**3 / 3)
    return np.asarray(part * np.asarray(radius) ** dimension)


def below_all(heights: Array, radius: ArrayLike) -> Array:
    """The same below all of two or three planes, of which one lies across each axis (..., d).

    Disks by their closed form, spheres by a quadrature of 32 nodes, good to 1e-4 of a sphere.

    >>> round(float(below_all(np.array([0.0, 0.0]), 1.0)) / math.pi, 12)
    0.25
    >>> round(float(below_all(np.array([0.0, 0.0, 0.0]), 1.0)) / math.pi, 4)  # 4/3/8
    0.1667
    """
    t = np.clip(heights / np.asarray(radius)[..., None], -1.0, 1.0)
    if heights.shape[-1] == 2:
        return np.asarray(_corner(t[..., 0], t[..., 1]) * np.asarray(radius) ** 2)
    # disks one above the other, at z = sin(angle), whose radius is cos(angle)
    end = np.arcsin(t[..., 2])
    half = 0.5 * (end + 0.5 * math.pi)
    angle = half[..., None] * (1 + NODES) - 0.5 * math.pi
    size = np.cos(angle)
    safe = np.maximum(size, 1e-12)
    a, b = (np.clip(t[..., k, None] / safe, -1.0, 1.0) for k in (0, 1))
    found = (_corner(a, b) * size**3) @ WEIGHTS * half
    return np.asarray(found * np.asarray(radius) ** 3)


def _corner(a: Array, b: Array) -> Array:
    """Area of the unit disk where x < a and y < b."""
    far = np.sqrt(1 - b * b)  # beyond, the plane y = b lies above or below the disk
    outer = _half(np.minimum(a, -far)) + _half(np.maximum(a, far)) - _half(far)
    inner = np.clip(a, -far, far)
    middle = b * (inner + far) + _half(inner) - _half(-far)
    return np.asarray(np.where(b > 0, 2 * outer, 0.0) + middle)


def _half(x: Array) -> Array:
    """Area of the upper half of the unit disk to the left of x."""
    return np.asarray(0.5 * (x * np.sqrt(np.maximum(1 - x * x, 0.0)) + np.arcsin(x) + math.pi / 2))


def whole(radius: Array, dimension: int) -> Array:
    """Areas of disks, or volumes of spheres."""
    return below(radius, radius, dimension)


def in_slabs(
    places: Array, radius: Array, region: Array, axis: int, edges: Array
) -> NDArray[np.float64]:
    """What spheres fill of each slab between two edges along an axis, within a region.

    Parameters
    ----------
    places: centres (n, d); images that reach into the region are spheres of their own.
    radius: (n,).
    region: [from, to] along each axis (d, 2); that along `axis` has no effect.
    edges: of the slabs (k + 1,), ascending.

    >>> one = np.array([[0.0, 0.0]]), np.array([1.0])
    >>> in_slabs(*one, np.array([[-2.0, 2], [0, 2]]), 0, np.array([-1.0, 0, 3])) / math.pi
    array([0.25, 0.25])
    """
    d, others = places.shape[1], [k for k in range(places.shape[1]) if k != axis]
    low, high = region[others].T
    across, along = places[:, others], places[:, axis]
    r = radius[:, None]
    touches = ((across + r > low) & (across - r < high)).all(axis=1)
    touches &= (along + radius > edges[0]) & (along - radius < edges[-1])
    within = touches & ((across - r >= low) & (across + r <= high)).all(axis=1)
    found = np.zeros(len(edges))
    if within.any():
        found += below(edges - along[within, None], r[within], d).sum(axis=0)
    if (cut := touches & ~within).any():
        # inclusion and exclusion over the corners of the region across the axis
        heights = np.empty((int(cut.sum()), len(edges), d))
        heights[..., 0] = edges - along[cut, None]
        for corner in range(2 ** len(others)):
            upper = np.array([corner >> k & 1 for k in range(len(others))], bool)
            heights[..., 1:] = (np.where(upper, high, low) - across[cut])[:, None, :]
            sign = (-1) ** int((~upper).sum())
            found += sign * below_all(heights, r[cut]).sum(axis=0)
    return np.diff(found)


def with_images(places: Array, radius: Array, period: Array) -> tuple[Array, Array]:
    """Centres and radii, and those of the images that reach into the box.

    period (d,): lengths after which the box repeats, 0 along closed axes.

    >>> with_images(np.array([[0.2, 3.0]]), np.array([0.5]), np.array([10.0, 0.0]))[0]
    array([[ 0.2,  3. ],
           [10.2,  3. ]])
    """
    for k in np.flatnonzero(period):
        parts = [(places, radius)]
        for shift, reaches in (
            (period[k], places[:, k] < radius),
            (-period[k], places[:, k] > period[k] - radius),
        ):
            moved = places[reaches].copy()
            moved[:, k] += shift
            parts.append((moved, radius[reaches]))
        places, radius = (np.concatenate(part) for part in zip(*parts, strict=True))
    return places, radius
