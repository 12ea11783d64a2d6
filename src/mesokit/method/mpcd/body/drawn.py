"""Bodies as other programs draw them: entries of `particles/type_shapes` of GSD files."""

import itertools
import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry.region import Part

Floats = NDArray[np.float64]
ROUND = 16  # corners of half a circle of a round end
UPRIGHT = (1.0, 0.0, 0.0)


def drawn_as(parts: Sequence[Part], dimension: int) -> dict[str, Any]:
    """The shape of a body, whose parts are in its own frame.

    Balls and ellipsoids keep their names; what is round and has no name becomes a polygon or a
    polyhedron with many corners, and a union of anything but balls a mesh.
    """
    if all(part.kind == "ball" for part in parts):
        diameters = [2.0 * part.numbers[6] for part in parts]
        if len(parts) == 1:
            return {"type": "Sphere", "diameter": diameters[0]}
        centres = [list(part.numbers[:3]) for part in parts]
        return {"type": "SphereUnion", "diameters": diameters, "centers": centres}
    if len(parts) == 1 and parts[0].kind == "ellipsoid" and parts[0].numbers[3:6] == UPRIGHT:
        along, wide = parts[0].numbers[6:8]
        return {"type": "Ellipsoid", "a": along, "b": wide, "c": wide}
    corners = [corners_of(part, dimension) for part in parts]
    if len(parts) > 1:
        return _mesh(corners, dimension)
    if dimension == 2:
        rim = corners[0][_hull(corners[0], 2).vertices, :2]
        return {"type": "Polygon", "rounding_radius": 0.0, "vertices": rim.tolist()}
    return {"type": "ConvexPolyhedron", "rounding_radius": 0.0, "vertices": corners[0].tolist()}


def _mesh(corners: Iterable[Floats], dimension: int) -> dict[str, Any]:
    """Triangles of the surfaces of convex parts, in 2D of their areas."""
    vertices: list[list[float]] = []
    triangles: list[list[int]] = []
    for part in corners:
        hull, first = _hull(part, dimension), len(vertices)
        faces = hull.simplices
        if dimension == 2:  # a fan about the first corner
            rim = hull.vertices
            faces = np.array([[rim[0], a, b] for a, b in itertools.pairwise(rim[1:])])
        else:  # seen from outside they turn to the left
            a, b, c = (part[faces[:, k]] for k in range(3))
            outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3])
            faces = np.where(outward[:, None] < 0, faces[:, ::-1], faces)
        triangles += (first + faces).tolist()
        vertices += part.tolist()
    return {"type": "Mesh", "vertices": vertices, "indices": triangles}


def _hull(corners: Floats, dimension: int) -> Any:
    from scipy.spatial import ConvexHull

    return ConvexHull(corners[:, :dimension])


def corners_of(part: Part, dimension: int) -> Floats:
    """Places (n, 3) on the surface of a primitive, all of its corners among them."""
    p = np.array(part.numbers)
    if part.kind == "brick":
        signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
        if dimension == 2:
            signs = signs[::2] * [1.0, 1.0, 0.0]
        x, y, z = (signs * p[3:6]).T
        return p[:3] + np.stack([p[6] * x - p[7] * y, p[7] * x + p[6] * y, z], axis=1)
    around = _sphere(dimension)
    if part.kind == "ball":
        return p[:3] + p[6] * around
    if part.kind == "ellipsoid":
        along = (around @ p[3:6])[:, None] * p[3:6]
        return p[:3] + p[7] * around + (p[6] - p[7]) * along
    ahead = (around @ p[3:6])[:, None] >= 0
    return p[:3] + np.where(ahead, p[3:6], 0.0) + p[6] * around


def _sphere(dimension: int) -> Floats:
    """Places (n, 3) all over a unit circle or sphere."""
    turns = math.pi * np.arange(2 * ROUND) / ROUND
    if dimension == 2:
        return np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    heights = np.cos(math.pi * np.arange(ROUND + 1) / ROUND)
    level, turn = np.meshgrid(heights, turns, indexing="ij")
    wide = np.sqrt(1.0 - level**2)
    places = np.stack([wide * np.cos(turn), wide * np.sin(turn), level], axis=-1).reshape(-1, 3)
    return np.unique(places.round(12), axis=0)
