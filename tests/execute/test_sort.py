"""Sorting brings the particles of a cell together, loses none and keeps their order."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mesokit.method.mpcd.engine.cpu.sort import sequence_of_cells
from tests.helpers.small_fluids import make_fluid

SIZE = (5, 7)


@given(
    n=st.integers(2, 5000), threads=st.sampled_from([1, 2, 3, 5]), seed=st.integers(0, 1000),
    spread=st.floats(1, 40),
)  # fmt: skip
@settings(max_examples=40)
def test_sort_is_a_stable_permutation(n, threads, seed, spread):
    random = np.random.default_rng(seed)
    fluid = make_fluid(SIZE, density=n / 35, threads=threads)
    assert fluid.n == n
    r = random.uniform(-spread, spread, (n, 2))
    ids = random.permutation(n).astype(np.int32)
    memory, by_number = fluid.memory, np.empty_like(r)
    by_number[ids] = r
    memory.fluid.particles.ident[:n] = ids
    memory.fill(by_number, by_number)
    fluid.sort()
    after = memory.fluid.particles.ident[:n]
    assert sorted(after) == list(range(n))
    rows = memory.read()[0][after]
    assert (rows >= 0).all() and (rows <= SIZE).all()
    cell = np.floor(rows[:, 0]) % 5 + 5 * (np.floor(rows[:, 1]) % 7)
    assert (np.diff(cell) >= 0).all()
    place = np.empty(n, int)
    place[ids] = np.arange(n)  # where each particle was
    for c in np.unique(cell):
        assert (np.diff(place[after[cell == c]]) > 0).all()
    np.testing.assert_allclose(fluid.positions(unwrapped=True)[ids], r, atol=1e-12)


@pytest.mark.parametrize("threads", [2, 3, 5])
def test_order_does_not_depend_on_threads(threads):
    orders = []
    for count in (1, threads):
        fluid = make_fluid((6, 7), density=9.5, threads=count)
        fluid.advance(300)
        orders.append(fluid.memory.fluid.particles.ident[: fluid.n].copy())
    np.testing.assert_array_equal(*orders)


@given(cells=st.tuples(st.integers(1, 9), st.integers(1, 20), st.integers(1, 20)))
def test_cells_in_space_come_in_pencils(cells):
    """All cells of a pencil lie together, layer by layer along x, in the order of pencils."""
    sequence = sequence_of_cells(cells, solids=False)
    count = np.prod(cells)
    assert sorted(sequence) == list(range(count + 1)) and sequence[-1] == count
    x, y, z = np.unravel_index(np.argsort(sequence[:-1]), cells, order="F")
    pencil, layer = z // 8 * cells[1] + y // 8, z % 8 * 8 + y % 8
    place = (pencil * cells[0] + x) * 64 + layer
    assert (np.diff(place) > 0).all()


def test_particles_in_space_lie_in_pencils():
    fluid = make_fluid((3, 12, 10), density=4, threads=1)
    fluid.sort()
    order = fluid.memory.fluid.particles.ident[: fluid.n]
    x, y, z = np.floor(fluid.positions()[order].T).astype(int)
    place = ((z // 8 * 2 + y // 8) * 3 + x) * 64 + z % 8 * 8 + y % 8
    assert (np.diff(place) >= 0).all() and len(np.unique(place)) > 300


def test_cells_of_a_plane_and_among_solids_come_by_rows():
    for cells, solids in (((5, 12), False), ((3, 12, 10), True)):
        np.testing.assert_array_equal(
            sequence_of_cells(cells, solids), np.arange(np.prod(cells) + 1)
        )
