"""An image of bodies of convex parts, as `shaded` has it of spheres: the same light and depths."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.region import Part
from mesokit.report.flow.data import Array
from mesokit.report.flow.shaded import DARK, FINER, LIGHT, MOST, SHADE

LEAST = 1e-12  # of a ray along a face or a rod
CAP, CAP_SHADE = 0.8, 0.35  # cosine of the half angle of a dark cap; what its colour is times


class Placed(NamedTuple):
    """A part, its body's place (3,) and rotation (3, 3) along the axes of the picture, the third
    towards the eye; its colour (3,), and whether the end along the body's axis x is dark."""

    part: Part
    place: Array
    turn: Array
    colour: Array
    capped: bool


def shaded_parts(
    placed: Sequence[Placed],
    room: tuple[float, float],
    low: tuple[float, float],
    high: tuple[float, float],
    dots: float,
) -> Any:
    """The image (rows from below, columns, 4) of what lies between two corners.

    `room`: the least and the largest depth; `dots`: pixels per unit length, see `shaded`.
    """
    dots = min(dots, MOST / max(high[0] - low[0], high[1] - low[1]))
    width, height = (max(1, round(dots * (b - a))) for a, b in zip(low, high, strict=True))
    columns, rows = (
        a + (np.arange(n * FINER) + 0.5) * (b - a) / (n * FINER)
        for a, b, n in zip(low, high, (width, height), strict=True)
    )
    nearest = np.full((len(rows), len(columns)), -np.inf, np.float32)
    colours = np.zeros((*nearest.shape, 3), np.float32)
    back, span = room[0], max(room[1] - room[0], 1e-300)
    for part, place, turn, colour, capped in placed:
        middle, reach = _held(part, place, turn)
        i, j = (
            slice(*np.searchsorted(along, [x - reach, x + reach]))
            for along, x in ((rows, middle[1]), (columns, middle[0]))
        )
        u, v = np.meshgrid(columns[j], rows[i])
        if not u.size:
            continue
        rays = np.stack([u, v, np.zeros_like(u)], axis=-1).reshape(-1, 3)
        z, normal = front(part, place, turn, rays)
        z = z.reshape(u.shape)
        seen = z > nearest[i, j]
        lit = SHADE + (1.0 - SHADE) * np.maximum(normal @ LIGHT, 0.0)
        lit *= 1.0 - DARK * (1.0 - np.clip((place[2] - back) / span, 0.0, 1.0))
        if capped:
            lit *= np.where(normal @ turn[:, 0] > CAP, CAP_SHADE, 1.0)
        nearest[i, j][seen] = z[seen]
        colours[i, j][seen] = lit.reshape(u.shape)[seen][:, None] * colour
    cells = (height, FINER, width, FINER)
    covered = (nearest > -np.inf).reshape(cells).sum(axis=(1, 3))
    mean = colours.reshape(*cells, 3).sum(axis=(1, 3)) / np.maximum(covered, 1)[..., None]
    image = np.concatenate([mean, covered[..., None] / FINER**2], axis=-1)
    return (255.0 * image + 0.5 * (image > 0)).astype(np.uint8)


def _held(part: Part, place: Array, turn: Array) -> tuple[Array, float]:
    """Centre and radius of a sphere that holds a part."""
    p = np.array(part.numbers)
    middle = p[:3] + 0.5 * p[3:6] if part.kind == "capsule" else p[:3]
    reach = {
        "ball": p[6],
        "ellipsoid": max(p[6:8]),
        "capsule": 0.5 * np.linalg.norm(p[3:6]) + p[6],
        "brick": np.linalg.norm(p[3:6]),
    }[part.kind]
    return place + turn @ middle, float(reach)


def front(part: Part, place: Array, turn: Array, rays: Array) -> tuple[Array, Array]:
    """Depth (n,) and unit normal (n, 3) where rays first meet a part; -inf for those that miss it.

    Rays come from the eye, against the third axis; each goes through a given place (n, 3) of
    depth 0.
    """
    p = np.array(part.numbers)
    away = rays - (place + turn @ p[:3])
    if part.kind == "ball":
        return _quadric(np.eye(3) / p[6], away)
    if part.kind == "ellipsoid":
        axis = turn @ p[3:6]
        along = np.outer(axis, axis)
        return _quadric(along / p[6] + (np.eye(3) - along) / p[7], away)
    if part.kind == "brick":
        own = turn @ np.array([[p[6], -p[7], 0.0], [p[7], p[6], 0.0], [0.0, 0.0, 1.0]])
        return _brick(own, p[3:6], away)
    assert part.kind == "capsule"
    span = turn @ p[3:6]
    long = float(np.linalg.norm(span))
    axis, ball = span / long, np.eye(3) / p[6]
    z, normal = _quadric(ball - np.outer(axis, axis) / p[6], away)
    with np.errstate(invalid="ignore"):  # rays that miss it
        height = away @ axis + z * axis[2]
    z = np.where((height >= 0) & (height <= long), z, -np.inf)
    for end in (away, away - span):
        other, n = _quadric(ball, end)
        normal = np.where((other > z)[:, None], n, normal)
        z = np.maximum(z, other)
    return z, normal


def _quadric(scale: Array, away: Array) -> tuple[Array, Array]:
    """Where |scale r| = 1; `scale` is symmetric."""
    start, step = away @ scale, scale[2]
    a, b, c = step @ step, start @ step, (start**2).sum(axis=1) - 1.0
    root = b * b - a * c
    met = (root >= 0) & (a > LEAST)
    z = np.where(met, (np.sqrt(np.maximum(root, 0.0)) - b) / max(a, LEAST), 0.0)
    normal = (start + z[:, None] * step) @ scale
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.where(met, z, -np.inf), normal / np.where(size > 0, size, 1.0)


def _brick(own: Array, half: Array, away: Array) -> tuple[Array, Array]:
    """Where rays meet a cuboid with axes `own` (3, 3), in columns, and these half sides."""
    start, step = away @ own, own[2]
    step = np.where(abs(step) < LEAST, LEAST, step)
    far = (np.sign(step) * half - start) / step
    near = (-np.sign(step) * half - start) / step
    face, z = far.argmin(axis=1), far.min(axis=1)
    return np.where(near.max(axis=1) < z, z, -np.inf), (own * np.sign(step)).T[face]
