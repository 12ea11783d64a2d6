"""The lattice that spheres start on: what is known of it without its sites."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mesokit.method.spheres.common.start.lattice import LatticeStart, nearest

LENGTHS = st.floats(3.0, 14.0)


@pytest.mark.parametrize("lattice", ["close-packed", "square"])
@pytest.mark.parametrize("dimension", [2, 3])
@given(data=st.data())
def test_no_two_sites_are_nearer_than_the_lattice_says(lattice, dimension, data):
    start = LatticeStart(lattice)
    size = np.array(data.draw(st.tuples(*[LENGTHS] * dimension)))
    shut = np.array(data.draw(st.tuples(*[st.booleans()] * dimension)))
    number = data.draw(st.integers(2, 300))
    spacing, found = (
        start.spacing(number, size),
        nearest(start.sites(number, size, shut), size, shut),
    )
    assert spacing <= found * (1 + 1e-12)


def test_a_full_lattice_has_that_spacing():
    start, size, open_axes = LatticeStart(), np.array([7.0, 12.0]), np.array([False, False])
    number = 98  # 7 x 7 cells of two sites
    sites = start.sites(number, size, open_axes)
    assert nearest(sites, size, open_axes) == pytest.approx(start.spacing(number, size), rel=1e-12)
