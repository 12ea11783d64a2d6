"""What is listed as near a cell: the same as if every term had been asked for every cell."""

import math

import numpy as np
import pytest

from mesokit import Array, Box, Disk, Solids
from mesokit.geometry.solids import survey
from mesokit.geometry.solids.bodies import REACH
from mesokit.geometry.solids.survey import Blocks
from tests.helpers.shapes import EVERY, SIZE, example

MANY = Array(of=Disk(centre=[3, 4], radius=1.7), repeat=[9, 8])


def one_by_one(solids, away):
    """Terms near each cell and the least clearance of its middle, from every term."""
    every = np.arange(solids._terms)
    whole = Blocks(2 * max(solids.size), np.array([0, len(every)]), every, np.full(1, np.inf))
    cells = math.prod(solids.size)
    starts, least = np.zeros(cells + 1, np.int64), np.zeros(cells)
    for _ in range(2):
        near = np.zeros(starts[-1], np.int64)
        survey.near_blocks(solids.kernel, solids.like, away, whole, Blocks(1, starts, near, least))
    return starts, near, least


@pytest.mark.parametrize(
    ("wall", "size"),
    [(None, SIZE[2]), (None, SIZE[3]), (MANY, (150, 90)), (MANY, (70, 200))],
    ids=["2D", "3D", "many", "tall"],
)
def test_blocks_leave_nothing_out(wall, size, tmp_path):
    shapes = [(n, s) for n, d, s in EVERY if d == len(size)] if wall is None else [(None, None)]
    for name, side in shapes:
        solids = Solids([wall or example(name, len(size), side, tmp_path)], Box(list(size)))
        for away in (REACH, 3.0):
            blocks = solids._near_cells(away)
            starts, near, least = one_by_one(solids, away)
            np.testing.assert_array_equal(blocks.starts, starts, err_msg=str(name))
            np.testing.assert_array_equal(blocks.near[: starts[-1]], near, err_msg=str(name))
            np.testing.assert_array_equal(blocks.least, least, err_msg=str(name))
