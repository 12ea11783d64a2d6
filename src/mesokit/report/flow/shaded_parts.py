"""An image of bodies of convex parts, as `shaded` has it of spheres: the same light and depths."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.region import Part
from mesokit.kernels.kernel import kernel
from mesokit.report.flow.data import Array
from mesokit.report.flow.shaded import DARK, FINER, LIGHT, MOST, SHADE

LEAST = 1e-12  # of a ray along a face or a rod
CAP, CAP_SHADE = 0.8, 0.35  # cosine of the half angle of a dark cap; what its colour is times


class Placed(NamedTuple):
    """A part, its body's place (3,) and rotation (3, 3) along the axes of the picture, the third
    towards the eye; the number of its colour; the direction in the body's frame in which its end is
    dark, or () for none.
    """

    part: Part
    place: Array
    turn: Array
    colour: int
    forward: tuple[float, ...]


class Surface(NamedTuple):
    """A cuboid, or all r with |matrix (r - middle)| = 1 no farther along an axis than `half[0]`.

    Of a cuboid `matrix` has the axes in its columns, and `half` half the sides.
    """

    cuboid: bool
    middle: Array
    matrix: Array
    half: Array
    axis: Array
    reach: float


class Look(NamedTuple):
    """How light a surface is, the number of its colour, and where its dark end looks, or zeros."""

    light: float
    colour: int
    ahead: Array


class Samples(NamedTuple):
    """Those of an image: its lower left corner, how many there are in a unit of length along each
    axis, and of each (rows, columns) the depth of what it sees, its light, and its colour or -1."""

    low: Array
    scale: Array
    nearest: Any
    lit: Any
    owner: Any


def shaded_parts(
    placed: Sequence[Placed],
    colours: Array,
    room: tuple[float, float],
    low: tuple[float, float],
    high: tuple[float, float],
    dots: float,
) -> Any:
    """The image (rows from below, columns, 4) of what lies between two corners.

    Parameters
    ----------
    placed: what is shown.
    colours: (n, 3) by number.
    room: the least and the largest depth, between which colours get darker.
    low, high: the corners.
    dots: pixels per unit length, see `shaded`.
    """
    dots = min(dots, MOST / max(high[0] - low[0], high[1] - low[1]))
    width, height = (max(1, round(dots * (b - a))) for a, b in zip(low, high, strict=True))
    scale = np.array([width / (high[0] - low[0]), height / (high[1] - low[1])]) * FINER
    nearest = np.full((height * FINER, width * FINER), -np.inf, np.float32)
    lit, owner = np.zeros_like(nearest), np.full(nearest.shape, -1, np.int16)
    samples = Samples(np.array(low, float), scale, nearest, lit, owner)
    back, span = room[0], max(room[1] - room[0], 1e-300)
    for part, place, turn, colour, forward in placed:
        light = 1.0 - DARK * (1.0 - min(max((place[2] - back) / span, 0.0), 1.0))
        ahead = np.zeros(3)
        if forward:
            ahead = turn @ forward / np.hypot.reduce(forward)
        look = Look(light, colour, ahead)
        for surface in surfaces(part, place, turn):
            front(surface, look, samples)
    covered = _of_pixels((owner >= 0).astype(np.float32))
    image = np.zeros((height, width, 4), np.float32)
    image[..., 3] = covered / FINER**2
    for number in sorted({one.colour for one in placed}):  # most have few of the colours
        own = _of_pixels(np.where(owner == number, lit, np.float32(0.0)))
        own /= np.maximum(covered, 1.0)
        for k in range(3):
            image[..., k] += own * np.float32(colours[number][k])
    image *= 255.0
    image += np.float32(0.5) * (covered > 0)[..., None]
    return image.astype(np.uint8)


def _of_pixels(samples: Any) -> Any:
    """Sums over the samples of each pixel, which is quicker than over axes of an array."""
    corners = [samples[i::FINER, j::FINER] for i in range(FINER) for j in range(FINER)]
    found = corners[0].copy()
    for corner in corners[1:]:
        found += corner
    return found


def surfaces(part: Part, place: Array, turn: Array) -> Iterator[Surface]:
    """The surfaces that a part of a turned body shows: of a capsule its side and its ends."""
    p, no_end, unit = np.array(part.numbers), np.full(3, np.inf), np.eye(3)
    middle = place + turn @ p[:3]
    if part.kind == "ball":
        yield Surface(False, middle, unit / p[6], no_end, unit[0], float(p[6]))
    elif part.kind == "ellipsoid":
        axis = turn @ p[3:6]
        along = np.outer(axis, axis)
        matrix = along / p[6] + (unit - along) / p[7]
        yield Surface(False, middle, matrix, no_end, axis, float(max(p[6:8])))
    elif part.kind == "brick":
        own = turn @ np.array([[p[6], -p[7], 0.0], [p[7], p[6], 0.0], [0.0, 0.0, 1.0]])
        yield Surface(True, middle, own, p[3:6], unit[0], float(np.hypot.reduce(p[3:6])))
    else:  # all within a radius of a line
        span = turn @ p[3:6]
        half = 0.5 * float(np.hypot.reduce(span))
        axis = span / (2.0 * half)
        matrix = (unit - np.outer(axis, axis)) / p[6]
        yield Surface(False, middle + 0.5 * span, matrix, np.full(3, half), axis, half + p[6])
        for end in (middle, middle + span):
            yield Surface(False, end, unit / p[6], no_end, axis, float(p[6]))


@kernel
def front(surface, look, samples):
    """Where rays first meet a surface, each through a sample of the image, against the third axis.

    A sample that sees it nearer than what was there gets its depth, light and colour.
    """
    low, scale, nearest = samples.low, samples.scale, samples.nearest
    rows, columns = nearest.shape
    x, y, reach = surface.middle[0] - low[0], surface.middle[1] - low[1], surface.reach
    first = max(0, int(np.ceil((y - reach) * scale[1] - 0.5)))
    last = min(rows - 1, int(np.floor((y + reach) * scale[1] - 0.5)))
    left = max(0, int(np.ceil((x - reach) * scale[0] - 0.5)))
    right = min(columns - 1, int(np.floor((x + reach) * scale[0] - 0.5)))
    start, step, normal, m = np.zeros(3), np.zeros(3), np.zeros(3), surface.matrix
    for k in range(3):
        step[k] = m[2, k]
        if surface.cuboid and abs(step[k]) < LEAST:
            step[k] = LEAST
    for row in range(first, last + 1):
        v = (row + 0.5) / scale[1] - y
        for column in range(left, right + 1):
            u = (column + 0.5) / scale[0] - x
            for k in range(3):
                start[k] = u * m[0, k] + v * m[1, k]
            if surface.cuboid:
                z, near, face = np.inf, -np.inf, 0
                for k in range(3):
                    side = np.sign(step[k]) * surface.half[k]
                    near = max(near, (-side - start[k]) / step[k])
                    far = (side - start[k]) / step[k]
                    if far < z:
                        z, face = far, k
                if near >= z:
                    continue
                for k in range(3):
                    normal[k] = np.sign(step[face]) * m[k, face]
            else:
                a, b, c = 0.0, 0.0, -1.0
                for k in range(3):
                    a += step[k] * step[k]
                    b += start[k] * step[k]
                    c += start[k] * start[k]
                root = b * b - a * c
                if root < 0.0 or a < LEAST:
                    continue
                z = (np.sqrt(root) - b) / a
                axis = surface.axis
                if abs(u * axis[0] + v * axis[1] + z * axis[2]) > surface.half[0]:
                    continue
                size = 0.0
                for k in range(3):
                    normal[k] = 0.0
                    for other in range(3):
                        normal[k] += m[k, other] * (start[other] + z * step[other])
                    size += normal[k] * normal[k]
                for k in range(3):
                    normal[k] /= np.sqrt(size)
            depth = surface.middle[2] + z
            if depth <= nearest[row, column]:
                continue
            bright, cosine = 0.0, 0.0
            for k in range(3):
                bright += normal[k] * LIGHT[k]
                cosine += normal[k] * look.ahead[k]
            bright = look.light * (SHADE + (1.0 - SHADE) * max(bright, 0.0))
            nearest[row, column] = depth
            samples.lit[row, column] = bright * CAP_SHADE if cosine > CAP else bright
            samples.owner[row, column] = look.colour
