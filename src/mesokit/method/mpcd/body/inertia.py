"""Volume, centre and inertia of a union of convex primitives of uniform density.

The inertia of each primitive is a closed form. Those of a union are added by the parallel-axis
theorem. Where parts overlap, the union is sampled on a fine grid instead.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry import primitive
from mesokit.geometry.region import Part, Region, moved
from mesokit.scalar.pointer import address

Floats = NDArray[np.float64]
FROM_AN_END = ("capsule",)  # kinds of primitives whose place is one of their ends
GRID = 96  # samples along the longest side of a union whose parts overlap


class Solid(NamedTuple):
    """A body about its centre of mass, in its own frame.

    volume (area in 2D); moments (3, 3): integral of (s s 1 - s s^T) over the volume, so that the
    inertia is density times this; parts: primitives; radius: of the smallest sphere about the
    centre that holds it; thinnest: twice the least half-width of its parts; overlaps: whether the
    numbers are sampled.
    """

    volume: float
    moments: Floats
    parts: tuple[Part, ...]
    radius: float
    thinnest: float
    overlaps: bool


def solid_of(region: Region, planar: bool) -> Solid:
    """The body that is the union of these primitives."""
    parts = [part for (part,) in region]
    masses = [_integrals(part, planar) for part in parts]
    overlaps = len(parts) > 1 and bool((_inside(parts, *_grid(parts, planar)[:1]) > 1).any())
    if overlaps:
        volume, centre, second = _sampled(parts, planar)
    else:
        volume = math.fsum(v for v, _, _ in masses)
        centre = sum((v * c for v, c, _ in masses), np.zeros(3)) / volume
        second = sum(
            (m + v * np.outer(c - centre, c - centre) for v, c, m in masses), np.zeros((3, 3))
        )
    moments = np.trace(second) * np.eye(3) - second
    own = tuple(part for (part,) in moved(region, (-centre).tolist()))
    radius = max(_extent(part) + float(np.hypot.reduce(middle_of(part))) for part in own)
    return Solid(volume, moments, own, radius, min(map(_width, own)), overlaps)


def middle_of(part: Part) -> Floats:
    """The centre of a primitive."""
    p = np.array(part.numbers)
    return p[:3] + 0.5 * p[3:6] if part.kind in FROM_AN_END else p[:3]


def _extent(part: Part) -> float:
    """How far a primitive reaches from its centre."""
    p = part.numbers
    return {
        "ball": lambda: p[6],
        "capsule": lambda: 0.5 * math.hypot(*p[3:6]) + p[6],
        "brick": lambda: math.hypot(*p[3:6]),
        "ellipsoid": lambda: max(p[6], p[7]),
    }[part.kind]()


def _width(part: Part) -> float:
    """The least width of a primitive."""
    p = part.numbers
    if part.kind == "brick":
        return 2.0 * min(x for x in p[3:6] if x > 0)
    return 2.0 * (min(p[6], p[7]) if part.kind == "ellipsoid" else p[6])


def _integrals(part: Part, planar: bool) -> tuple[float, Floats, Floats]:
    """Volume, centre, and second moments (3, 3) about the centre of a primitive."""
    p, d = part.numbers, 2 if planar else 3
    across = np.diag([1.0, 1.0, 0.0 if planar else 1.0])
    if part.kind == "ball":
        volume = math.pi * p[6] ** 2 if planar else 4.0 / 3.0 * math.pi * p[6] ** 3
        return volume, middle_of(part), volume * p[6] ** 2 / (d + 2) * across
    if part.kind == "brick":
        sides = np.array(p[3:6])
        volume = float(np.prod(2.0 * sides[:d]))
        turn = np.array([[p[6], -p[7], 0.0], [p[7], p[6], 0.0], [0.0, 0.0, 1.0]])
        return volume, middle_of(part), volume / 3.0 * turn @ np.diag(sides**2) @ turn.T
    if part.kind == "ellipsoid":
        along, wide, axis = p[6], p[7], np.array(p[3:6])
        volume = math.pi * along * wide
        volume *= 1.0 if planar else 4.0 / 3.0 * wide
        both = np.outer(axis, axis)
        shares = along**2 * both + wide**2 * (across - both)
        return volume, middle_of(part), volume / (d + 2) * shares
    radius, length = p[6], math.hypot(*p[3:6])  # a capsule: a rod, and two halves of a ball
    axis = np.array(p[3:6]) / length
    both, half = np.outer(axis, axis), 0.5 * length
    if planar:
        rod, ends = 2.0 * radius * length, math.pi * radius**2
        centre, own, flat = 4.0 * radius / (3.0 * math.pi), radius**2 / 4.0, radius**2 / 3.0
    else:
        rod, ends = math.pi * radius**2 * length, 4.0 / 3.0 * math.pi * radius**3
        centre, own, flat = 3.0 / 8.0 * radius, radius**2 / 5.0, radius**2 / 4.0
    lengthwise = rod * half**2 / 3.0 + ends * (own + half**2 + 2.0 * half * centre)
    second = lengthwise * both + (rod * flat + ends * own) * (across - both)
    return rod + ends, middle_of(part), second


def _grid(parts: list[Part], planar: bool) -> tuple[Floats, float]:
    """Middles (n, 3) of small cubes around all parts, and the volume of one."""
    d = 2 if planar else 3
    reach = np.array([[_extent(part)] * 3 for part in parts])
    middles = np.array([middle_of(part) for part in parts])
    low, high = (middles - reach).min(axis=0)[:d], (middles + reach).max(axis=0)[:d]
    step = float((high - low).max()) / GRID
    along = [np.arange(a + 0.5 * step, b, step) for a, b in zip(low, high, strict=True)]
    places = np.stack(np.meshgrid(*along, indexing="ij"), -1).reshape(-1, d)
    return places, step**d


def _inside(parts: list[Part], places: Floats) -> NDArray[np.int64]:
    """How many parts each place is in."""
    found = np.zeros(len(places), np.int64)
    nothing = np.zeros(1)
    for part in parts:
        numbers = np.array(part.numbers)
        depth = [
            primitive.distance(part.code, address(numbers), address(nothing), tuple(place))
            for place in places
        ]
        found += np.array(depth) < -1e-9
    return found


def _sampled(parts: list[Part], planar: bool) -> tuple[float, Floats, Floats]:
    """Volume, centre and second moments of a union whose parts overlap."""
    places, small = _grid(parts, planar)
    inside = np.pad(places[_inside(parts, places) > 0], ((0, 0), (0, 1 if planar else 0)))
    centre = inside.mean(axis=0)
    away = inside - centre
    own = small ** (2.0 / (2 if planar else 3)) / 12.0  # of a small cube about its middle
    second = small * (away.T @ away + own * len(inside) * np.diag([1, 1, 0 if planar else 1]))
    return small * len(inside), centre, second
