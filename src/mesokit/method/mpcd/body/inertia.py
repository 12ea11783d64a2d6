"""Volume, centre and inertia of a union of convex primitives of uniform density.

The inertia of each primitive is a closed form. Those of a union are added by the parallel-axis
theorem. Where parts overlap, the union is sampled on a fine grid instead.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry import primitive
from mesokit.geometry.primitive import PRIMITIVES
from mesokit.geometry.primitive.moments import Integrals, plane
from mesokit.geometry.region import Part, Region, moved
from mesokit.geometry.solids.cut_cube import share_and_depth
from mesokit.kernels.later import kernel
from mesokit.method.mpcd.body.drawn import corners_of
from mesokit.scalar.pointer import address
from mesokit.scalar.vector import row

Floats = NDArray[np.float64]
GRID = 96  # samples along the longest side of a union whose parts overlap
INSIDE = -1e-9  # cells: parts that only touch do not overlap


class Solid(NamedTuple):
    """A body about its centre of mass, in its own frame.

    volume (area in 2D); moments (3, 3): integral of (s s 1 - s s^T) over the volume, so that the
    inertia is density times this; parts: primitives; radius: of the smallest sphere about the
    centre that holds it; thinnest: the least width of its parts; overlaps: whether the numbers are
    sampled; ball: whether it is a disk or a sphere.
    """

    volume: float
    moments: Floats
    parts: tuple[Part, ...]
    radius: float
    thinnest: float
    overlaps: bool
    ball: bool


def solid_of(region: Region, planar: bool) -> Solid:
    """The body that is the union of these primitives."""
    d, parts = 2 if planar else 3, [part for (part,) in region]
    own = [PRIMITIVES[part.code].integrals(part.numbers, d) for part in parts]
    overlaps = len(parts) > 1 and bool((_inside(parts, _grid(parts, own, d)[0]) > 1).any())
    volume, centre, second = _sampled(parts, own, d) if overlaps else _joined(own)
    about = tuple(part for (part,) in moved(region, (-centre).tolist()))
    extents = [PRIMITIVES[part.code].extent(part.numbers) for part in parts]
    widths = [PRIMITIVES[part.code].width(part.numbers) for part in parts]
    away = [float(np.hypot.reduce(one.centre - centre)) for one in own]
    return Solid(
        volume,
        np.trace(second) * np.eye(3) - second,
        about,
        max(x + y for x, y in zip(extents, away, strict=True)),
        min(widths),
        overlaps,
        len(parts) == 1 and widths[0] == 2.0 * extents[0],
    )


def _joined(own: list[Integrals]) -> Integrals:
    """Those of parts that do not overlap, by the parallel-axis theorem."""
    volume = math.fsum(one.volume for one in own)
    centre = sum((one.volume * one.centre for one in own), np.zeros(3)) / volume
    second = np.zeros((3, 3))
    for one in own:
        second += one.second + one.volume * np.outer(one.centre - centre, one.centre - centre)
    return Integrals(volume, centre, second)


def _grid(parts: list[Part], own: list[Integrals], d: int) -> tuple[Floats, float]:
    """Middles (n, d) of small cubes around all parts, and the side of one."""
    middles = np.array([one.centre for one in own])
    reach = np.array([[PRIMITIVES[part.code].extent(part.numbers)] * 3 for part in parts])
    low, high = (middles - reach).min(axis=0)[:d], (middles + reach).max(axis=0)[:d]
    step = float((high - low).max()) / GRID
    counts = np.ceil((high - low) / step - 1e-9).astype(int)
    start = 0.5 * (low + high - (counts - 1) * step)
    along = [a + step * np.arange(n) for a, n in zip(start, counts, strict=True)]
    return np.stack(np.meshgrid(*along, indexing="ij"), -1).reshape(-1, d), step


def _inside(parts: list[Part], places: Floats, depth: float = INSIDE) -> NDArray[np.int64]:
    """How many parts each place is in, or nearer to than minus a depth."""
    found, table = np.zeros(len(places), np.int64), np.array([part.numbers for part in parts])
    zero = (0.0,) * places.shape[1]
    for part, numbers in zip(parts, table, strict=True):
        count_inside(part.code, address(numbers), depth, zero, np.ascontiguousarray(places), found)
    return found


def separate_pieces(solid: Solid, dimension: int) -> int:
    """In how many separate pieces a body is; gaps narrower than two samples do not count."""
    from scipy import ndimage

    if len(solid.parts) == 1:
        return 1
    parts = list(solid.parts)
    own = [PRIMITIVES[part.code].integrals(part.numbers, dimension) for part in parts]
    places, step = _grid(parts, own, dimension)
    at = np.rint((places - places.min(axis=0)) / step).astype(int)
    near = np.zeros(at.max(axis=0) + 1, bool)
    near[tuple(at.T)] = _inside(parts, places, step) > 0
    return int(ndimage.label(near, np.ones((3,) * dimension))[1])


def hidden_parts(solid: Solid, dimension: int) -> list[tuple[int, int]]:
    """Numbers of parts that lie wholly in another one, and of that one, from 0.

    Of an ellipsoid it is places on the surface that do.
    """
    found: list[tuple[int, int]] = []
    for i, part in enumerate(solid.parts):
        places, radius = _core(part, dimension)
        for j, other in enumerate(solid.parts):
            if j == i or (j, i) in found:
                continue
            if (_inside([other], places, -radius - INSIDE) > 0).all():
                found.append((i, j))
                break
    return found


def _core(part: Part, dimension: int) -> tuple[Floats, float]:
    """Places (n, d) and a distance: a convex solid holds the part if it holds all that is so near
    to these places."""
    p = np.array(part.numbers)
    if part.kind in ("brick", "ellipsoid"):
        return corners_of(part, dimension)[:, :dimension], 0.0
    ends = [p[:3]] if part.kind == "ball" else [p[:3], p[:3] + p[3:6]]
    return np.array(ends)[:, :dimension], float(p[6])


def is_inside(solid: Solid, place: Sequence[float]) -> bool:
    """Whether a place in the frame of a body is inside of it."""
    return bool(_inside(list(solid.parts), np.array([place], float))[0] > 0)


@kernel
def count_inside(code, numbers, depth, zero, places, found):
    """Count a part for each of the places (n, d) that are deeper in it than a depth."""
    for n in range(len(places)):
        if primitive.distance(code, numbers, numbers, row(places, n, zero)) < depth:
            found[n] += 1


@kernel
def fill_cubes(code, numbers, step, zero, places, least, share):
    """Share (n,) of small cubes about places (n, d) that is in parts, by the nearest of them.

    A plane stands for the surface. `least` (n,) are the distances of those that came before.
    """
    for n in range(len(places)):
        r = row(places, n, zero)
        c = primitive.distance(code, numbers, numbers, r)
        if c < least[n]:
            least[n], share[n] = c, 1.0 if c < 0.0 else 0.0
            if abs(c) < step:
                _, normal = primitive.facing(code, numbers, numbers, r)
                share[n], _ = share_and_depth(c / step, normal)


def _sampled(parts: list[Part], own: list[Integrals], d: int) -> Integrals:
    """Those of a union whose parts overlap, from small cubes and the share of each inside."""
    places, step = _grid(parts, own, d)
    table, zero = np.array([part.numbers for part in parts]), (0.0,) * d
    least, share = np.full(len(places), np.inf), np.zeros(len(places))
    for part, numbers in zip(parts, table, strict=True):
        fill_cubes(part.code, address(numbers), step, zero, places, least, share)
    cubes, whole = np.pad(places, ((0, 0), (0, 3 - d))), float(share.sum())
    centre, small = share @ cubes / whole, step**d
    away = cubes - centre
    second = (share[:, None] * away).T @ away + whole * step**2 / 12.0 * plane(d)
    return Integrals(small * whole, centre, small * second)
