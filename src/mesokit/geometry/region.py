"""Solids as unions of intersections of primitives and their complements: the algebra of shapes.

>>> region = ball((1.0, 1.0), 0.5)
>>> [[part.sign for part in term] for term in complement(union([region, region]))]
[[-1.0, -1.0]]
>>> union(region, region) == union([region, region]), union(region) == region
(True, True)
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.geometry.primitive import KINDS, WIDTH

IMAGED = ("ball", "rod", "capsule", "brick", "sampled", "ellipsoid")
Vector = Sequence[float]


class Room(NamedTuple):
    """The box, and which of its axes plates close."""

    size: tuple[int, ...]
    closed: tuple[bool, ...]

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return len(self.size)


class Part(NamedTuple):
    """A primitive (sign 1) or its complement (sign -1): its kind, its parameters, its samples."""

    kind: str
    numbers: tuple[float, ...]
    sign: float = 1.0
    samples: NDArray[np.float64] | None = None

    def moved(self, by: Vector) -> Part:
        """The part after a displacement."""
        x, y, z, *others = self.numbers
        dx, dy, dz = _three(by)
        return Part(self.kind, (x + dx, y + dy, z + dz, *others), self.sign, self.samples)

    def repeats(self, axis: int) -> bool:
        """Whether it is its own image beyond the ends of an axis."""
        return self.kind == "sampled" and self.numbers[9 + axis] > 0.5

    @property
    def code(self) -> int:
        """Its number at run time."""
        return KINDS[self.kind]


Term = tuple[Part, ...]
Region = tuple[Term, ...]


def union(*regions: Region | Iterable[Region]) -> Region:
    """The union of regions, given as a list or one by one."""
    return tuple(term for region in _listed(regions) for term in region)


def intersection(*regions: Region | Iterable[Region]) -> Region:
    """The common part of regions, given as a list or one by one."""
    return tuple(tuple(itertools.chain(*terms)) for terms in itertools.product(*_listed(regions)))


def _listed(given: tuple[Any, ...]) -> Iterable[Region]:
    """The regions of a single list of regions, or the regions themselves."""
    first = given[0] if len(given) == 1 else ()
    alone = isinstance(first, tuple) and first and isinstance(first[0][0], Part)
    return first if len(given) == 1 and not alone else given


def complement(region: Region) -> Region:
    """The space outside of a region."""
    return tuple(
        tuple(part._replace(sign=-part.sign) for part in parts)
        for parts in itertools.product(*region)
    )


def moved(region: Region, by: Vector) -> Region:
    """The region after a displacement."""
    return tuple(tuple(part.moved(by) for part in term) for term in region)


def images(region: Region, room: Room) -> list[tuple[Term, Vector]]:
    """The terms and their images beyond each end of the box that is open, with their displacement.

    Half-spaces and waves have none: they go on for ever, and fit the box as they are or not at all.
    """
    steps = [
        (0.0,) if shut else (0.0, -float(length), float(length))
        for length, shut in zip(room.size, room.closed, strict=True)
    ]
    found: dict[Any, tuple[Term, Vector]] = {}
    for term in region:
        bounded = any(part.kind in IMAGED and part.sign > 0 for part in term)
        own = [
            (0.0,) if all(part.repeats(axis) for part in term) else along
            for axis, along in enumerate(steps)
        ]
        for by in itertools.product(*own) if bounded else [(0.0,) * room.dimension]:
            image = tuple(part.moved(by) for part in term)
            key = tuple((p.kind, p.numbers, p.sign, id(p.samples)) for p in image)
            found.setdefault(key, (image, by))
    return list(found.values())


def half_space(point: Vector, normal: Vector) -> Region:
    """Everything behind the plane through a point, whose normal looks into the fluid."""
    size = math.hypot(*normal)
    return _one("half_space", _three(point) + _three([x / size for x in normal]))


def ball(centre: Vector, radius: float) -> Region:
    """A disk or a sphere."""
    return _one("ball", (*_three(centre), 0.0, 0.0, 0.0, radius))


def rod(point: Vector, axis: Vector, radius: float) -> Region:
    """A cylinder without ends."""
    size = math.hypot(*axis)
    return _one("rod", (*_three(point), *_three([x / size for x in axis]), radius))


def capsule(start: Vector, end: Vector, radius: float) -> Region:
    """All within a radius of a straight line."""
    span = [b - a for a, b in zip(start, end, strict=True)]
    square = math.fsum(x * x for x in span)
    return _one("capsule", (*_three(start), *_three(span), radius, 1.0 / square))


def ellipsoid(centre: Vector, axis: Vector, along: float, across: float) -> Region:
    """An ellipse or an ellipsoid of revolution, by half its lengths along the axis and across."""
    size = math.hypot(*axis)
    return _one("ellipsoid", (*_three(centre), *_three([x / size for x in axis]), along, across))


def brick(centre: Vector, size: Vector, degrees: float = 0.0) -> Region:
    """A rectangle or cuboid, turned about z."""
    half, angle = _three([0.5 * x for x in size]), math.radians(degrees)
    return _one("brick", (*_three(centre), *half, math.cos(angle), math.sin(angle)))


def wave(
    place: Vector, along: int, across: int, amplitude: float, per_length: float, above: bool
) -> Region:
    """One side of a cosine with a crest at a place; the fluid lies above it or below."""
    side = 1.0 if above else -1.0
    return _one("wave", (*_three(place), float(along), float(across), amplitude, per_length, side))


def sampled(
    values: NDArray[np.float64], origin: Vector, spacing: float, repeats: Sequence[bool]
) -> Region:
    """A signed distance on a grid, linear between its points."""
    shape = _three(values.shape, 1.0)
    steep = max(1.0, float(steepness(values, repeats).max()) / spacing)
    ends = _three([float(again) for again in repeats])
    numbers = (*_three(origin), spacing, *shape, 0.0, steep, *ends)
    return ((Part("sampled", numbers, samples=np.ascontiguousarray(values, float)),),)


def steepness(values: NDArray[np.float64], repeats: Sequence[bool]) -> NDArray[np.float64]:
    """A bound of the gradient within the cell that starts at each sample, per spacing.

    Along each axis the slope within a cell lies between those of its edges.
    """
    total = np.zeros(values.shape)
    for axis in range(values.ndim):
        slope = np.abs(np.roll(values, -1, axis) - values)
        for other in range(values.ndim):
            if other != axis:
                slope = np.maximum(slope, np.roll(slope, -1, other))
        total += slope**2
    for axis, again in enumerate(repeats):
        if not again:  # no cell starts at the last
            np.moveaxis(total, axis, -1)[..., -1] = 0.0
    return np.sqrt(total)


def _one(kind: str, numbers: Vector) -> Region:
    padded = tuple(float(x) for x in numbers) + (0.0,) * (WIDTH - len(numbers))
    return ((Part(kind, padded),),)


def _three(values: Any, missing: float = 0.0) -> tuple[float, ...]:
    numbers = tuple(float(x) for x in values)
    return numbers + (missing,) * (3 - len(numbers))
