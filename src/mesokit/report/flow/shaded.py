"""An image of spheres: each pixel shows the one that is nearest there, lit from the upper left.

Parallel rays, so that lengths can be read off the axes; what lies farther back is darker. Light
only darkens a colour, which keeps its hue: so it can be compared with a colour bar.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.report.flow.data import Array

FINER = 2  # samples of a pixel along each axis
MOST = 3000  # pixels along an axis
LIGHT = np.array([-0.4, 0.5, 0.77]) / np.linalg.norm([-0.4, 0.5, 0.77])
SHADE = 0.5  # least part of a colour, away from the light
DARK = 0.4  # part of the colour that is lost at the back


class Balls(NamedTuple):
    """Places (n, 2), depths (n,) towards the eye, radii (n,), colours (n, 3), and the least and the
    largest depth, between which colours get darker."""

    places: Array
    depth: Array
    radii: Array
    colours: Array
    room: tuple[float, float]


def shaded(balls: Balls, low: tuple[float, float], high: tuple[float, float], dots: float) -> Any:
    """The image (rows from below, columns, 4) of what lies between two corners.

    `dots` are its pixels per unit length. Numbers are from 0 to 255; it is clear where nothing is.

    >>> one = Balls(np.array([[1.0, 1.0]]), np.zeros(1), np.ones(1), np.ones((1, 3)), (0.0, 0.0))
    >>> image = shaded(one, (0.0, 0.0), (2.0, 2.0), 10)
    >>> image.shape, int(image[10, 10, 3]), int(image[0, 0, 3])
    ((20, 20, 4), 255, 0)
    """
    longer = max(high[0] - low[0], high[1] - low[1])
    dots = min(dots, MOST / longer)
    width, height = (max(1, round(dots * (b - a))) for a, b in zip(low, high, strict=True))
    scale = np.array([width / (high[0] - low[0]), height / (high[1] - low[1])]) * FINER
    owner = np.full((height * FINER, width * FINER), -1, np.int32)
    nearest = np.full(owner.shape, -np.inf, np.float32)
    front(np.argsort(-balls.depth), balls, np.array(low), scale, nearest, owner)
    image = np.zeros((height, width, 4), np.uint8)
    light(balls, np.array(low), scale, owner, image)
    return image


@kernel
def front(order, balls, low, scale, nearest, owner):
    """Which sphere is the nearest at each sample, and its depth there; quick if the first are."""
    rows, columns = owner.shape
    # A depth buffer: each sphere covers its own circle of samples, from front to back, so most
    # samples behind are left out by one comparison.
    for k in order:
        r, depth = balls.radii[k], balls.depth[k]
        x, y = balls.places[k, 0] - low[0], balls.places[k, 1] - low[1]
        first = max(0, int(np.ceil((y - r) * scale[1] - 0.5)))
        last = min(rows - 1, int(np.floor((y + r) * scale[1] - 0.5)))
        for row in range(first, last + 1):
            v = (row + 0.5) / scale[1] - y
            half = np.sqrt(max(r * r - v * v, 0.0))
            left = max(0, int(np.ceil((x - half) * scale[0] - 0.5)))
            right = min(columns - 1, int(np.floor((x + half) * scale[0] - 0.5)))
            for column in range(left, right + 1):
                if depth + r <= nearest[row, column]:
                    continue
                u = (column + 0.5) / scale[0] - x
                z = depth + np.sqrt(max(r * r - u * u - v * v, 0.0))
                if z > nearest[row, column]:
                    nearest[row, column] = z
                    owner[row, column] = k


@kernel
def light(balls, low, scale, owner, image):
    """Colours of the pixels from those of their samples."""
    back, span = balls.room[0], max(balls.room[1] - balls.room[0], 1e-300)
    for row in range(image.shape[0]):
        for column in range(image.shape[1]):
            covered, red, green, blue = 0, 0.0, 0.0, 0.0
            for sample in range(FINER * FINER):
                i, j = row * FINER + sample // FINER, column * FINER + sample % FINER
                k = owner[i, j]
                if k < 0:
                    continue
                r = balls.radii[k]
                u = ((j + 0.5) / scale[0] + low[0] - balls.places[k, 0]) / r
                v = ((i + 0.5) / scale[1] + low[1] - balls.places[k, 1]) / r
                w = np.sqrt(max(1.0 - u * u - v * v, 0.0))
                lit = max(u * LIGHT[0] + v * LIGHT[1] + w * LIGHT[2], 0.0)
                away = 1.0 - min(max((balls.depth[k] - back) / span, 0.0), 1.0)
                lit = (1.0 - DARK * away) * (SHADE + (1.0 - SHADE) * lit)
                covered += 1
                red += lit * balls.colours[k, 0]
                green += lit * balls.colours[k, 1]
                blue += lit * balls.colours[k, 2]
            if covered > 0:
                image[row, column, 0] = np.uint8(255.0 * red / covered + 0.5)
                image[row, column, 1] = np.uint8(255.0 * green / covered + 0.5)
                image[row, column, 2] = np.uint8(255.0 * blue / covered + 0.5)
                image[row, column, 3] = np.uint8(255.0 * covered / (FINER * FINER))
