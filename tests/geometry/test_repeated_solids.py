"""Walls that repeat themselves in a large box: one period is surveyed for all."""

import numpy as np
import pytest

from mesokit import Array, Box, Capsule, Disk, Sphere
from mesokit.geometry.solids import cut_cells
from mesokit.geometry.solids.solids import Solids

ROUNDING = 1e-9  # of a height: places of copies are rounded
WALLS = {
    "posts": ([Array(of=Disk([4.3, 5.9], 2.7), repeat=[5, 3])], (50, 36), (10, 12)),
    "spheres": ([Array(of=Sphere([3.7, 4, 4.4], 2.2), repeat=[2, 3, 2])], (18, 24, 16), (9, 8, 8)),
    "over an edge": ([Array(of=Disk([0.4, 11.8], 3.1), repeat=[4, 3])], (48, 36), (12, 12)),
    "two arrays": (
        [
            Array(of=Disk([3.3, 3.1], 1.6), repeat=[4, 2]),
            Array(of=Capsule([6.5, 14], [8, 14.5], 0.9), repeat=[2, 2]),
        ],
        (48, 40),
        (24, 20),
    ),
}


@pytest.mark.parametrize("name", WALLS)
def test_tables_are_those_of_a_search_of_the_whole_box(name, monkeypatch):
    walls, size, period = WALLS[name]
    found = []
    for large in (10**9, 1):
        monkeypatch.setattr(cut_cells, "LARGE", large)
        solids = Solids(walls, Box(list(size)))  # another each time: searches are kept
        assert solids.period == period
        tables = [make(solids, size) for make in (cut_cells.cut_cells, cut_cells.cut_planes)]
        low, high = (3,) * len(size), tuple(n - 5 for n in size)
        block = [
            make(solids, size, (low, high)) for make in (cut_cells.cut_cells, cut_cells.cut_planes)
        ]
        found.append([*tables[0], *tables[1], *block[0], *block[1]])
    for whole, again in zip(*found, strict=True):
        np.testing.assert_allclose(again, whole, atol=ROUNDING)


def test_what_does_not_repeat_in_whole_cells_is_searched_as_a_whole():
    for walls in ([Disk([8, 8], 3)], [Array(of=Disk([4, 4], 2), repeat=[5, 2])]):
        assert Solids(walls, Box([32, 32])).period == (32, 32)


def test_a_large_box_is_surveyed_by_one_period(monkeypatch):
    searched = []
    survey = cut_cells._surveyed
    monkeypatch.setattr(
        cut_cells, "_surveyed", lambda s, m: (searched.append(len(m)), survey(s, m))[1]
    )
    monkeypatch.setattr(cut_cells, "LARGE", 2**12)
    size = (160, 120)
    solids = Solids([Array(of=Disk([4.1, 5.2], 3), repeat=[16, 12])], Box(list(size)))
    planes = cut_cells.cut_planes(solids, size)
    assert sum(searched) * 16 * 12 == len(planes[1])
