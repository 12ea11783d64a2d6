"""The planes that stand for the surfaces in cut cells, for any shift of the cells."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from mesokit.geometry.solids.clearance import (
    OFFSETS,
    PARTS,
    Held,
    clear_squares,
    cube_middles,
    free_planes,
)
from mesokit.geometry.solids.cut_cells import EVERYWHERE, cut_cells, cut_planes
from mesokit.geometry.solids.cut_cube import share_and_depth
from tests.helpers.shapes import EVERY, example, solids_of, walls_of


def cells_of(solids):
    """Collision cells along each axis."""
    return tuple(n + shut for n, shut in zip(solids.size, solids.room.closed, strict=True))


@pytest.mark.parametrize("case", EVERY, ids=lambda case: "-".join(map(str, case)))
def test_planes_cut_off_what_is_solid(case, tmp_path):
    """Wherever the shift is in its interval; all together without bias, though the smallest bodies
    here have radii below two cells."""
    name, d, side = case
    solids = solids_of(walls_of(example(name, d, side, tmp_path), d), d)
    normals, heights, middles, terms, _ = cut_planes(solids, cells_of(solids))
    live = np.flatnonzero(heights < EVERYWHERE)
    assert (terms[live] >= 0).all()
    assert np.allclose((normals[live] ** 2).sum(axis=1), 1.0)
    rng, total, expected = np.random.default_rng(1), 0.0, 0.0
    for _ in range(6 if len(live) < 200 else 2):
        moved = (rng.random((len(live), d)) - 0.5) / OFFSETS[d]
        share = 1.0 - solids.open_part(middles[live] - moved, 1.0)
        now = heights[live] - (normals[live] * moved).sum(axis=1)
        cut = [share_and_depth(h, tuple(n))[0] for h, n in zip(now, normals[live], strict=True)]
        assert abs(cut - share).max(initial=0.0) < 0.35
        total, expected = total + sum(cut), expected + share.sum()
    assert total == pytest.approx(expected, rel=0.02)


STRIDE = 0.45


@pytest.mark.parametrize("case", EVERY, ids=lambda case: "-".join(map(str, case)))
def test_nothing_is_where_tables_say_so(case, tmp_path):
    """No solid but plates is nearer to a small cube than the table has it, nor above its plane as
    near as a stride."""
    name, d, side = case
    solids = solids_of(walls_of(example(name, d, side, tmp_path), d), d)
    clear, parts = clear_squares(solids, 0.0)
    plane_of, planes, reach = free_planes(solids, clear, STRIDE, 0.0)
    assert parts == PARTS[d]
    assert reach == STRIDE
    rng, sides = np.random.default_rng(2), [n * parts for n in solids.size]
    some = rng.integers(len(clear) - 1, size=2000)  # the last is of no cube
    near = np.flatnonzero(plane_of >= 0)
    some = np.concatenate([some, rng.choice(near, min(len(near), 2000))])
    start = cube_middles(some, sides, parts) + (rng.random((len(some), d)) - 0.5) / parts
    way = rng.standard_normal((len(some), d))
    way /= np.linalg.norm(way, axis=1)[:, None]
    ends = start + way * np.sqrt(clear[some] * rng.random(len(some)))[:, None]
    assert (solids.distance(ends, plates=False)[clear[some] > 0.0] >= 0.0).all()
    ends = start + way * (STRIDE * rng.random(len(some)))[:, None]
    known = plane_of[some] >= 0
    normals, heights = planes[plane_of[some[known]], :d], planes[plane_of[some[known]], d]
    above = (normals * ends[known]).sum(axis=1) > heights
    assert (solids.distance(ends[known], plates=False)[above] >= 0.0).all()


def test_planes_lie_on_surfaces(tmp_path):
    """All of the fluid within half a cell of a flat surface, and most of it at a round one, is
    above a plane."""
    for name, least in (("rectangle", 0.9), ("disk", 0.9), ("picture", 0.7)):
        solids = solids_of(walls_of(example(name, 2, "outside", tmp_path), 2), 2)
        clear, parts = clear_squares(solids, 0.0)
        plane_of, planes, _ = free_planes(solids, clear, STRIDE, 0.0)
        points = np.random.default_rng(3).random((20_000, 2)) * solids.size
        distance = solids.distance(points, plates=False)
        points = points[(distance > 0.0) & (distance < 0.3)]
        cubes = np.floor(points * parts).astype(int) @ [1, solids.size[0] * parts]
        known = plane_of[cubes] >= 0
        found = (planes[plane_of[cubes], :2] * points).sum(axis=1) > planes[plane_of[cubes], 2]
        assert (known & found).mean() > least, name


@pytest.mark.parametrize("d", [2, 3])
def test_tables_of_a_part_are_those_of_the_whole(d, tmp_path):
    """A rank knows its part of the box, also across an end of it; of the rest it knows nothing."""
    solids = solids_of(
        walls_of(example("disk" if d == 2 else "sphere", d, "outside", tmp_path), d), d
    )
    clear, parts = clear_squares(solids, 0.0)
    plane_of, planes, _ = free_planes(solids, clear, STRIDE, 0.0)
    held = Held((-3,) * d, tuple(n - 2 for n in solids.size))
    some, _ = clear_squares(solids, 0.0, held)
    near, flat, _ = free_planes(solids, some, STRIDE, 0.0, held)
    numbers = np.arange(len(some) - 1)
    middles = cube_middles(numbers, [n * parts for n in held.cells], parts, held.first)
    cubes = np.floor(middles % solids.size * parts).astype(int)
    there = cubes @ np.cumprod([1, *(n * parts for n in solids.size[:-1])])
    assert (some[:-1] == clear[there]).all()
    assert some[-1] == 0.0 == clear[-1]
    assert near[-1] == -1 == plane_of[-1]
    known = near[:-1] >= 0
    assert known.any()
    assert (known == (plane_of[there] >= 0)).all()
    assert (flat[near[:-1][known]] == planes[plane_of[there[known]]]).all()
    cells, low, high = cells_of(solids), (2,) * d, tuple(n - 3 for n in cells_of(solids))
    starts, which, corners = cut_cells(solids, cells)
    inside = ((corners >= low) & (corners < high)).all(axis=1)
    of_block = cut_cells(solids, cells, (low, high))
    assert (
        np.diff(of_block[0]) == [inside[a:b].sum() for a, b in itertools.pairwise(starts)]
    ).all()
    assert (of_block[1] == which[inside]).all()
    assert (of_block[2] == corners[inside]).all()
    there, here = cut_planes(solids, cells), cut_planes(solids, cells, (low, high))
    assert all((column[inside] == own).all() for column, own in zip(there, here, strict=True))
