"""Room of bodies at their start: free places for more of them, and which overlap what."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.geometry import primitive
from mesokit.geometry.primitive import PRIMITIVES, WIDTH
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import solids_of
from mesokit.kernels.later import kernel
from mesokit.method.mpcd.body.inertia import Solid
from mesokit.method.mpcd.engine.bodies.state import FOUR, load, rotated, rotated_back
from mesokit.method.mpcd.start.draws import Draws
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import address
from mesokit.scalar.random import INITIAL_BODIES
from mesokit.scalar.vector import added, added_scaled, dot, row

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
TRIES = 20_000  # places that are drawn for a body before there is no room
MOST_DRAWS = 5_000_000  # for all bodies of a kind
TOUCH = 1e-6  # cells: surfaces that are nearer overlap
NEAREST = 0.3  # of the range of a gap law: 10^6 kT nearer than that, and the first step flings them
PROJECTIONS = 200
FINE = 0.25  # cells between places on a surface that is tried against walls
SHELLS = (1.0, 0.7, 0.4, 0.1)  # smaller surfaces within it, for walls that lie inside


class Apart(NamedTuple):
    """Bodies of a kind: a tree of their places, and how far others stay from these."""

    tree: cKDTree
    reach: float


class Shape(NamedTuple):
    """The parts of a kind of bodies, for compiled code."""

    part_code: Any
    table: Any
    parts: int


def shape_of(solid: Solid) -> Shape:
    """The parts of a body."""
    table = np.array([part.numbers for part in solid.parts])
    return Shape(np.array([part.code for part in solid.parts]), table, address(table))


def open_lengths(case: Case) -> Floats:
    """Lengths of the box, 0 where walls close it."""
    closed = closed_axes(case.walls)
    lengths = zip(case.box.axes, case.box.size, strict=True)
    return np.array([0.0 if axis in closed else float(length) for axis, length in lengths])


def tree_of(places: Floats, period: Floats) -> cKDTree:
    """A tree of places (n, d) in a periodic box."""
    from scipy.spatial import cKDTree

    length = np.where(period > 0, period, 1.0)
    inside = places - np.floor(places / length) * length
    inside[inside >= length] = 0.0  # of places a rounding below 0
    return cKDTree(np.where(period > 0, inside, places), boxsize=period)


def walls_away(case: Case, reach: float) -> Callable[[Floats], Floats]:
    """The function of places (n, d) that gives their distance from walls, or `reach` if larger."""
    if not case.walls:
        return lambda places: np.full(len(places), reach)
    look = solids_of(case).depths(reach)
    return lambda places: np.minimum(look(places)[1], reach)


def free_places(
    case: Case, ids: Ids, reach: float, wall: float, others: Sequence[Apart]
) -> tuple[Floats, int]:
    """Places (n, d) of bodies with these numbers, and how many found one.

    They are two `reach` from one another, as far from others as both say, `wall` from walls. All
    that have none draw one at a time; of two that are too near the later draws again.
    """
    d, size, period = case.box.dimension, np.array(case.box.size, float), open_lengths(case)
    clear = walls_away(case, wall)
    random, left, draws = Draws(case.run.seed, INITIAL_BODIES, ids), np.arange(len(ids)), 0
    places, mine = np.zeros((len(ids), d)), list(others)
    for _ in range(TRIES):
        x = random.units(d) * size
        draws += len(x)
        good = clear(x) >= wall
        for tree, far in mine:
            good[good] = tree.query(x[good])[0] >= far + reach
        rows = np.flatnonzero(good)
        if len(rows):
            near = tree_of(x[rows], period).query_pairs(2.0 * reach, output_type="ndarray")
            kept = np.ones(len(rows), bool)
            for i, j in near[np.lexsort((near[:, 0], near[:, 1]))].tolist():
                kept[j] &= not kept[i]
            good[rows[~kept]] = False
            places[left[good]] = x[good]
            left, random = left[~good], random.of(~good)
            done = np.setdiff1d(np.arange(len(ids)), left)
            mine = [*others, Apart(tree_of(places[done], period), reach)]
        if not len(left) or draws > MOST_DRAWS:
            break
    return places, len(ids) - len(left)


# --- overlaps -------------------------------------------------------------------------------------


def overlap(case: Case, places: Floats, turns: Floats) -> tuple[int, int] | None:
    """Two bodies, by number, that overlap; None where there are none."""
    d, period = case.box.dimension, open_lengths(case)
    solids, rows = [kind.solid(d) for kind in case.bodies], _rows(case)
    trees = [tree_of(places[some], period) for some in rows]
    for a, b in itertools.combinations_with_replacement(range(len(solids)), 2):
        reach = solids[a].radius + solids[b].radius
        if solids[a].ball and solids[b].ball:
            reach += least_gap(case.bodies[a], case.bodies[b])
        near = trees[a].sparse_distance_matrix(trees[b], reach, output_type="ndarray")
        if a == b:
            near = near[near["i"] < near["j"]]
        i, j = near["i"] + rows[a].start, near["j"] + rows[b].start
        if solids[a].ball and solids[b].ball:
            bad = near["v"] < reach - TOUCH
        else:
            away = places[j] - places[i]
            away -= period * np.rint(away / np.where(period > 0, period, 1.0))
            bad = _overlapping(solids[a], solids[b], away, turns[i], turns[j], period)
        if bad.any():
            first = np.lexsort((j[bad], i[bad]))[0]
            return int(i[bad][first]), int(j[bad][first])
    return None


def least_gap(one: Any, other: Any) -> float:
    """The gap below which two balls do not start."""
    ranges = [kind.interaction.range for kind in (one, other) if kind.interaction.depth]
    return NEAREST * max(ranges, default=0.0)


def _rows(case: Case) -> list[slice]:
    """The numbers of the bodies of each kind."""
    ends = np.cumsum([kind.number for kind in case.bodies]).tolist()
    return [slice(end - kind.number, end) for kind, end in zip(case.bodies, ends, strict=True)]


def _overlapping(
    one: Solid, other: Solid, away: Floats, turns: Floats, others: Floats, period: Floats
) -> NDArray[np.bool_]:
    """Which pairs of bodies overlap, all images of the second among them."""
    found = np.zeros(len(away), bool)
    for step in itertools.product(*[(0.0, -x, x) if x else (0.0,) for x in period.tolist()]):
        by = away + step
        near = np.flatnonzero(~found & ((by**2).sum(axis=1) < (one.radius + other.radius) ** 2))
        if len(near):
            gaps, zero = np.zeros(len(near)), (0.0,) * len(period)
            pairs = by[near], turns[near], others[near]
            find_gaps(shape_of(one), shape_of(other), zero, pairs, gaps)
            found[near] = gaps < TOUCH
    return found


@kernel
def find_gaps(one, other, zero, pairs, gaps):
    """The distance of two bodies, 0 where they overlap: places of the second as seen from the
    first, and orientations of both."""
    away, turns, others = pairs
    for n in range(len(away)):
        y, q, p = row(away, n, zero), load(turns, n, 0, FOUR), load(others, n, 0, FOUR)
        least = math.inf
        for a in range(len(one.part_code)):
            for b in range(len(other.part_code)):
                mine, theirs = into_part(one, a, zero, q, y), y
                for _ in range(PROJECTIONS):
                    theirs = into_part(other, b, y, p, mine)
                    before, mine = mine, into_part(one, a, zero, q, theirs)
                    step = added_scaled(mine, -1.0, before)
                    if dot(step, step) < 1e-18:
                        break
                gap = added_scaled(mine, -1.0, theirs)
                least = min(least, math.sqrt(dot(gap, gap)))
        gaps[n] = least


@scalar
def into_part(shape, part, x, q, r):
    """The place in a part, of a body at x, that is nearest to r."""
    y = rotated_back(q, added_scaled(r, -1.0, x))
    p, code = shape.parts + 8 * WIDTH * part, shape.part_code[part]
    c = primitive.distance(code, p, shape.parts, y)
    if c <= 0.0:
        return r
    return added(x, rotated(q, added_scaled(y, -c, primitive.normal(code, p, shape.parts, y))))


# --- walls ----------------------------------------------------------------------------------------


def deepest_in_wall(case: Case, places: Floats, turns: Floats) -> tuple[int, float] | None:
    """The body, by number, that is deepest in a wall, and how deep; None where none is."""
    d, found = case.box.dimension, (-1, TOUCH)
    for kind, rows in zip(case.bodies, _rows(case), strict=True):
        solid = kind.solid(d)
        look = walls_away(case, solid.radius)
        far = look(places[rows])
        points = np.zeros((1, 3)) if solid.ball else _within(solid, d)
        for i in np.flatnonzero(far < solid.radius).tolist():
            depth = solid.radius - far[i]
            if not solid.ball:
                body = rows.start + i
                depth = -look(places[body] + _turned(turns[body], points)[:, :d]).min()
            if depth > found[1]:
                found = rows.start + i, float(depth)
    return found if found[0] >= 0 else None


def _within(solid: Solid, d: int) -> Floats:
    """Places (n, 3) on the surface of a body and on smaller ones within, in its own frame."""
    shape, nothing, found = shape_of(solid), np.zeros(1), []
    for part, numbers in zip(solid.parts, shape.table, strict=True):
        middle = PRIMITIVES[part.code].integrals(part.numbers, d).centre
        p, samples = address(numbers), address(nothing)
        # The nearest places to those on a ball about it: on what is convex they are no farther
        # from one another than there.
        for r in (middle + solid.radius * _directions(solid.radius, d)).tolist():
            at = tuple(r[:d])
            c = primitive.distance(part.code, p, samples, at)
            n = primitive.normal(part.code, p, samples, at)
            place = np.zeros(3)
            place[:d] = np.array(at) - c * np.array(n)
            found += [middle + share * (place - middle) for share in SHELLS]
    return np.array(found)


def _directions(radius: float, d: int) -> Floats:
    """Unit vectors (n, 3), FINE apart on a ball of this radius."""
    if d == 2:
        angle = np.linspace(0.0, 2.0 * math.pi, math.ceil(2.0 * math.pi * radius / FINE))
        return np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
    n = math.ceil(4.0 * math.pi * (radius / FINE) ** 2)
    z, angle = (2.0 * np.arange(n) + 1.0) / n - 1.0, math.pi * (1.0 + 5.0**0.5) * np.arange(n)
    across = np.sqrt(1.0 - z**2)
    return np.stack([across * np.cos(angle), across * np.sin(angle), z], axis=1)


def _turned(q: Floats, vectors: Floats) -> Floats:
    """Vectors (n, 3), turned by a unit quaternion."""
    twist = 2.0 * np.cross(q[1:], vectors)
    turned: Floats = vectors + q[0] * twist + np.cross(q[1:], twist)
    return turned
