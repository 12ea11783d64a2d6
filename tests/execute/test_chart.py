"""The planes that stand for the surfaces in cut cells, for any shift of the cells."""

from __future__ import annotations

import numpy as np
import pytest
from shapes import EVERY, example, solids_of, walls_of

from mesokit.execute.chart import EVERYWHERE, OFFSETS, cut_cells, cut_planes
from mesokit.geometry.cut_cube import share_and_depth


def cells_of(solids):
    """Collision cells along each axis."""
    return tuple(n + shut for n, shut in zip(solids.size, solids.room.closed, strict=True))


@pytest.mark.parametrize("case", EVERY, ids=lambda case: "-".join(map(str, case)))
def test_planes_cut_off_what_is_solid(case, tmp_path):
    """Wherever the shift is in its interval; all together without bias, though the smallest bodies
    here have radii below two cells."""
    name, d, side = case
    solids = solids_of(walls_of(example(name, d, side, tmp_path), d), d)
    starts, _, corners = cut_cells(solids, cells_of(solids))
    normals, heights, middles, terms, _ = cut_planes(solids, corners, starts)
    live = np.flatnonzero(heights < EVERYWHERE)
    assert (terms[live] >= 0).all()
    assert np.allclose((normals[live] ** 2).sum(axis=1), 1.0)
    rng, total, expected = np.random.default_rng(1), 0.0, 0.0
    for _ in range(8 if len(live) < 200 else 3):
        moved = (rng.random((len(live), d)) - 0.5) / OFFSETS[d]
        share = 1.0 - solids.open_part(middles[live] - moved, 1.0)
        now = heights[live] - (normals[live] * moved).sum(axis=1)
        cut = [share_and_depth(h, tuple(n))[0] for h, n in zip(now, normals[live], strict=True)]
        assert abs(cut - share).max(initial=0.0) < 0.35
        total, expected = total + sum(cut), expected + share.sum()
    assert total == pytest.approx(expected, rel=0.02)
