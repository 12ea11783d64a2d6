"""Records of cells to rows of lanes and back, against plain NumPy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from mesokit.loops.layout import LANES, QUAD, SCRATCH_ROW, record_length, sums_length
from mesokit.method.mpcd.engine.cpu.collide import put_block
from mesokit.method.mpcd.engine.cpu.stages import add_strip
from mesokit.method.mpcd.engine.cpu.strips import records

CELLS = 12

gather = njit(lambda data, cell, i, rows, pattern: records.gather(data, cell, i, rows, pattern))
spread = njit(lambda data, start, i, rows, pattern: records.spread(data, start, i, rows, pattern))


@njit
def scatter_add(sums, cell, i, rows, pattern, tallied):
    records.scatter_add(sums, cell, i, rows, pattern, tallied)


take = njit(
    lambda sums, start, i, rows, pattern: records.gather_sums(sums, start, i, rows, pattern)
)
put = njit(lambda data, start, count, rows, pattern: put_block(data, start, count, rows, pattern))
add = njit(
    lambda cell, rows, sums, count, pattern: add_strip(cell, rows, sums, count, pattern, (), ())
)

for_every_count = pytest.mark.parametrize("count", range(1, 21))
cells = st.lists(st.integers(0, CELLS - 1), min_size=LANES, max_size=LANES)
lane = st.integers(0, LANES - QUAD)
seeds = st.integers(0, 2**32 - 1)
often = settings(max_examples=10)


def numbers(seed, rows, columns, kind):
    """A flat array, and the view (rows, columns) of it: all bits of integers are in use."""
    whole = np.random.default_rng(seed).integers(-(2**63), 2**63 - 1, rows * columns)
    flat = whole if kind is int else whole * 2.0**-60
    return flat, flat.reshape(rows, columns)


@for_every_count
@often
@given(seed=seeds, cell=cells, i=lane)
def test_gather(count, seed, cell, i):
    cell = np.array(cell, np.int32)
    data, record = numbers(seed, CELLS, record_length(count), float)
    flat, rows = numbers(seed + 1, count, SCRATCH_ROW, float)
    expected = rows.copy()
    expected[:, i : i + QUAD] = record[cell[i : i + QUAD], :count].T
    gather(data, cell, i, flat, (0.0,) * count)
    np.testing.assert_array_equal(rows, expected)


@for_every_count
@often
@given(seed=seeds, start=st.integers(0, CELLS - QUAD), i=lane)
def test_spread(count, seed, start, i):
    data, record = numbers(seed, CELLS, record_length(count), float)
    flat, rows = numbers(seed + 1, count, SCRATCH_ROW, float)
    expected = record.copy()
    expected[start : start + QUAD, :count] = rows[:, i : i + QUAD].T
    spread(data, start, i, flat, (0.0,) * count)
    np.testing.assert_array_equal(record[:, :count], expected[:, :count])


def added_up(sums, cell, rows, lanes, counts=None):
    """What the sums shall be when these lanes have been added one by one."""
    expected = sums.copy()
    for j in lanes:
        expected[cell[j], 0] += 1 if counts is None else counts[j]
        expected[cell[j], 1 : len(rows) + 1] += rows[:, j]
    return expected


@for_every_count
@often
@given(seed=seeds, cell=cells, i=lane, alike=st.booleans())
def test_scatter_add(count, seed, cell, i, alike):
    cell = np.array(cell, np.int32)
    cell[i : i + QUAD] = cell[i] if alike else cell[i : i + QUAD]
    data, sums = numbers(seed, CELLS, sums_length(count), int)
    flat, rows = numbers(seed + 1, count, SCRATCH_ROW, int)
    expected = added_up(sums, cell, rows, range(i, i + QUAD))
    scatter_add(data, cell, i, flat, (0,) * count, ())
    np.testing.assert_array_equal(sums, expected)


@pytest.mark.parametrize("count", (2, 3, 4, 7))
def test_scatter_add_with_counts_of_its_own(count):
    cell = np.array([3, 5, 3, 3] * (SCRATCH_ROW // QUAD), np.int32)
    data, sums = numbers(1, CELLS, sums_length(count), int)
    flat, rows = numbers(2, count + 1, SCRATCH_ROW, int)
    expected = added_up(sums, cell, rows[:count], range(8, 12), rows[count])
    scatter_add(data, cell, 8, flat, (0,) * count, (0,))
    np.testing.assert_array_equal(sums, expected)


@for_every_count
@often
@given(seed=seeds, start=st.integers(0, CELLS - QUAD), i=lane)
def test_take(count, seed, start, i):
    data, sums = numbers(seed, CELLS, sums_length(count), int)
    flat, rows = numbers(seed + 1, count + 1, SCRATCH_ROW, int)
    expected, left = rows.copy(), sums.copy()
    expected[:, i : i + QUAD] += sums[start : start + QUAD, : count + 1].T
    left[start : start + QUAD] = 0
    take(data, start, i, flat, (0,) * count)
    np.testing.assert_array_equal(rows, expected)
    np.testing.assert_array_equal(sums, left)


@pytest.mark.parametrize("count", (1, 4, 7))
@pytest.mark.parametrize("rest", range(QUAD))
@often
@given(seed=seeds, cell=cells, quads=st.integers(0, LANES // QUAD - 1))
def test_strip_of_any_number_of_lanes(count, rest, seed, cell, quads):
    cell = np.array(cell, np.int32)
    lanes = quads * QUAD + rest
    data, sums = numbers(seed, CELLS, sums_length(count), int)
    flat, rows = numbers(seed + 1, count, SCRATCH_ROW, int)
    expected = added_up(sums, cell, rows, range(lanes))
    add(cell, flat, data, lanes, (0,) * count)
    np.testing.assert_array_equal(sums, expected)


@pytest.mark.parametrize("count", (1, 4, 7))
@pytest.mark.parametrize("lanes", range(2 * QUAD))
def test_block_of_any_number_of_cells(count, lanes):
    data, record = numbers(lanes, CELLS, record_length(count), float)
    flat, rows = numbers(lanes + 1, count, SCRATCH_ROW, float)
    expected = record[:, :count].copy()
    expected[2 : 2 + lanes] = rows[:, :lanes].T
    put(data, 2, lanes, flat, (0.0,) * count)
    np.testing.assert_array_equal(record[:, :count], expected)
