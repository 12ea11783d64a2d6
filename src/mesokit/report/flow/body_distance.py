"""Signed distance from the surface of a body, whose convex parts are in its own frame."""

from collections.abc import Sequence

import numpy as np

from mesokit.geometry.region import Part
from mesokit.report.flow.data import Array

LEAST = 1e-20  # halves of an ellipse: no place counts as nearer to its longer axis
TRIES, CONVERGED = 100, 1e-9


def distance(parts: Sequence[Part], places: Array) -> Array:
    """Distances of places (n, d) in the body's frame, negative inside.

    >>> from mesokit.geometry.region import ball, capsule
    >>> (one,), (rod,) = ball((0, 0), 1), capsule((0, 0), (3, 0), 0.5)
    >>> distance(one + rod, np.array([[0.0, 2.0], [4.0, 0.0], [0.0, 0.0]])).tolist()
    [1.0, 0.5, -1.0]
    """
    return np.min([_of_part(part, places) for part in parts], axis=0)


def _of_part(part: Part, places: Array) -> Array:
    p, d = np.array(part.numbers), places.shape[1]
    away = places - p[:d]
    if part.kind == "ball":
        return np.linalg.norm(away, axis=1) - p[6]
    if part.kind == "brick":
        turned = away.copy()
        turned[:, 0] = p[6] * away[:, 0] + p[7] * away[:, 1]
        turned[:, 1] = p[6] * away[:, 1] - p[7] * away[:, 0]
        beyond = abs(turned) - p[3 : 3 + d]
        outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
        return np.where(outside > 0, outside, beyond.max(axis=1))
    if part.kind == "ellipsoid":
        height = away @ p[3 : 3 + d]
        radius = np.linalg.norm(away - height[:, None] * p[3 : 3 + d], axis=1)
        if p[6] < p[7]:
            return _from_ellipse(p[6], p[7], abs(height), radius)
        return _from_ellipse(p[7], p[6], radius, abs(height))
    span = p[3 : 3 + d]  # all within a radius of a line
    along = np.clip(p[7] * away @ span, 0.0, 1.0)
    return np.linalg.norm(away - along[:, None] * span, axis=1) - p[6]


def _from_ellipse(short: float, long: float, y: Array, z: Array) -> Array:
    """Signed distance of (y, z), both >= 0, from the ellipse with these halves.

    By Newton's method, from a start below the root: see `mesokit.geometry.primitive.ellipsoid`.
    """
    ratio = (long / short) ** 2
    k, y, z = ratio - 1.0, np.maximum(y / short, LEAST), ratio * z / long
    w = np.maximum(y, z - k)
    for _ in range(TRIES):
        a, b = y / w, z / (w + k)
        square = a * a + b * b
        step = square * (np.sqrt(square) - 1.0) / (a * a / w + b * b / (w + k))
        w = np.maximum(w + step, y)
        if (abs(step) < CONVERGED * w).all():
            break
    return (w - 1.0) * short**2 * np.hypot(y / w / short, z / (w + k) / long)
