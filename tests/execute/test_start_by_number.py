"""Where a particle starts, and how fast, follows from its number alone."""

import numpy as np
import pytest
from scipy import stats

from mesokit.method.mpcd.start.draws import draw_places, draw_velocities

SIZE = np.array([8.0, 20.0, 12.0])


def places(who, attempt=0):
    out = np.empty((len(who), 3))
    draw_places(3, np.asarray(who), attempt, SIZE, out)
    return out


@pytest.mark.parametrize("first", [0, 700, 2**33])
def test_any_part_of_the_particles_is_that_part_of_all(first):
    whole = places(np.arange(first, first + 300))
    np.testing.assert_array_equal(places(np.arange(first + 100, first + 150)), whole[100:150])
    np.testing.assert_array_equal(places([first + 7]), whole[7:8])


def test_places_are_uniform_and_each_has_its_own():
    found = places(np.arange(50_000)) / SIZE
    for k in range(3):
        assert stats.kstest(found[:, k], "uniform").pvalue > 1e-4
    assert len(np.unique(found)) == found.size
    again = places(np.arange(50_000), attempt=1) / SIZE
    for a in range(3):
        for b in range(3):
            assert abs(np.corrcoef(found[:, a], again[:, b])[0, 1]) < 5 / np.sqrt(len(found))


def test_velocities_are_maxwellian_by_their_masses():
    mass = np.repeat([1.0, 4.0], 40_000)
    found = np.empty((len(mass), 3))
    draw_velocities(3, 2.0, mass, (0.0,) * 3, found)
    for some, spread in ((slice(0, 40_000), 2.0**0.5), (slice(40_000, None), 0.5**0.5)):
        for k in range(3):
            assert stats.kstest(found[some, k] / spread, "norm").pvalue > 1e-4
    few = np.empty((10, 3))
    draw_velocities(3, 2.0, mass[:10], (0.0,) * 3, few)
    np.testing.assert_array_equal(few, found[:10])
