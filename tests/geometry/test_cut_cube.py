"""A cube cut by a plane: volume and mean depth against sums over a fine grid."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from mesokit.geometry.solids.cut_cube import share_and_depth, share_beyond

FINE = {2: 400, 3: 60}


def grid(d):
    """Middles of small cubes that fill the unit cube about 0."""
    along = (np.arange(FINE[d]) + 0.5) / FINE[d] - 0.5
    return np.stack(np.meshgrid(*[along] * d, indexing="ij"), -1).reshape(-1, d)


@given(
    st.sampled_from([2, 3]),
    st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3),
    st.floats(-1.2, 1.2),
)
@example(3, [1.0, 1.5e-6, 1.5e-6], 0.2)
@example(3, [1.0, 2e-4, 2e-4], 0.499)
@example(2, [1.0, 0.0, 0.0], -0.3)
def test_share_and_depth(d, direction, height):
    n = np.array(direction[:d])
    if np.hypot.reduce(n) < 1e-3:
        n[0] = 1.0
    n /= np.hypot.reduce(n)
    heights = height + grid(d) @ n
    behind = heights < 0
    share, depth = share_and_depth(height, tuple(n))
    step = 1.0 / FINE[d]
    assert share == pytest.approx(behind.mean(), abs=2 * step)
    assert share_beyond(height, tuple(n)) == pytest.approx(1.0 - behind.mean(), abs=2 * step)
    assert 0.0 <= depth <= 0.5 * np.abs(n).sum() - height + 1e-12 or share == 0.0
    if behind.mean() > 0.05:
        assert depth == pytest.approx(-heights[behind].mean(), abs=2 * step)
