"""Energy and number of particles in one integer come apart again."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numba import njit

from mesokit.method.mpcd.engine.cpu.strips.cell_energy import (
    Column,
    NotNeeded,
    WithCount,
    tally,
    untangled,
)

SCALE = 2.0**20
FASTEST = (2.0**32 / SCALE) ** 0.5


@njit
def summed(energy, m, v):
    total = np.int64(0)
    for i in range(len(v)):
        total += tally(energy, m, (v[i], 0.0))[0]
    return untangled(energy, total)


@given(v=st.lists(st.floats(0, FASTEST), max_size=200), m=st.floats(0.01, 1.0))
def test_number_is_exact_and_energy_rounded(v, m):
    number, energy = summed(WithCount(SCALE), m, np.array(v))
    assert number == len(v)
    assert abs(energy - sum(m * x * x for x in v)) <= 0.51 * len(v) / SCALE


def test_the_fullest_cell_of_the_fastest_particles():
    v = np.full(65535, FASTEST * (1 - 1e-6))
    number, energy = summed(WithCount(SCALE), 1.0, v)
    assert number == 65535
    np.testing.assert_allclose(energy, (v**2).sum(), rtol=1e-9)


def test_nothing_is_told_where_nobody_asks():
    plain = njit(lambda energy: untangled(energy, np.int64(7)))
    assert plain(NotNeeded()) == (7, 0.0)
    assert plain(Column()) == (7, 0.0)
