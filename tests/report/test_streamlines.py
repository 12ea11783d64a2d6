"""Streamlines are whole, apart from one another, and where the velocity says."""

import numpy as np
import pytest

from mesokit.report.flow import quiver, streamlines
from mesokit.report.flow.data import Flow
from mesokit.report.flow.follow import Nodes, lines
from mesokit.report.flow.region import Region
from mesokit.report.flow.smooth import rim_filled

LOW, HIGH = np.zeros(2), np.array([40.0, 20.0])


def nodes(velocity, hole=False):
    x, y = np.arange(81) * 0.5, np.arange(41) * 0.5
    v = np.stack(np.broadcast_arrays(*velocity(*np.meshgrid(x, y, indexing="ij"))), axis=-1)
    v = v.astype(float)
    if hole:
        v[30:50, 15:25] = np.nan
    return Nodes(x, y, v)


def test_lines_of_a_parallel_flow_go_from_end_to_end():
    found = lines(nodes(lambda x, y: (y * (20 - y), 0 * x)), LOW, HIGH, 2.0)
    assert 6 <= len(found) <= 11
    for line in found:
        assert np.ptp(line[:, 1]) < 1e-9 and np.ptp(line[:, 0]) > 39
        assert (np.diff(line[:, 0]) > 0).all()  # along the flow
    heights = np.sort([line[0, 1] for line in found])
    assert np.diff(heights).min() >= 0.9 * 2.0


def test_lines_of_a_rotation_close_once():
    found = lines(nodes(lambda x, y: (10 - y, x - 20)), LOW, HIGH, 2.0)
    radii = [np.hypot(line[:, 0] - 20, line[:, 1] - 10) for line in found]
    whole = [r for r in radii if r.max() < 9]
    assert len(whole) >= 2 and max(np.ptp(r) for r in whole) < 0.1
    for r, line in zip(radii, found, strict=True):
        if r.max() < 9:
            length = np.hypot(*np.diff(line, axis=0).T).sum()
            assert 0.85 < length / (2 * np.pi * r.mean()) < 1.1


def test_lines_end_at_solids_and_at_rest():
    for line in lines(nodes(lambda x, y: (1 + 0 * x, 0 * y), hole=True), LOW, HIGH, 2.0):
        inside = (abs(line[:, 0] - 19.75) < 4.5) & (abs(line[:, 1] - 9.75) < 2)
        assert not inside.any()
    assert lines(nodes(lambda x, y: (0 * x, 0 * y)), LOW, HIGH, 2.0) == []


def test_noise_alone_has_no_direction():
    noise = np.random.default_rng(1).normal(size=(80, 40, 2))
    velocity = 0.1 * noise[::-1] + np.where(np.arange(40) < 20, 5.0, 0.0)[None, :, None] * [1, 0]
    flow = Flow(("x", "y"), (40.0, 20.0), 2, velocity=velocity, noise=0.1 * noise)
    quiet = streamlines.quiet(flow)
    assert np.isfinite(quiet[:, :15]).all()
    assert np.isnan(quiet[:, 25:, 0]).mean() > 0.1
    assert np.std(quiet[5:-5, 3:15, 1]) < 0.05  # smoother than it was


def test_colours_run_as_those_of_the_speed():
    """Slow is dark in both maps, so that they can be read side by side."""
    flow = Flow(("x", "y"), (4.0, 4.0), 2, velocity=np.ones((4, 4, 2)))
    colours = streamlines.scale(flow, 1.0).colours
    grey = np.array([0.299, 0.587, 0.114])
    assert np.dot(colours(0.0)[:3], grey) < np.dot(colours(1.0)[:3], grey) < 0.75


def test_bins_that_solids_cut_take_the_mean_of_their_neighbours():
    velocity, share = np.ones((6, 6, 2)), np.ones((6, 6))
    velocity[2, 3], share[2, 3] = 50.0, 0.1
    velocity[0, 0], share[0, 0] = np.nan, 0.0
    filled = rim_filled(velocity, share, (False, False))
    assert filled[2, 3] == pytest.approx(1.0) and np.isnan(filled[0, 0]).all()
    assert velocity[2, 3, 0] == 50.0  # what was measured stays


def test_no_arrow_stands_half_in_a_solid():
    velocity = np.ones((64, 64, 2))
    velocity[:, :3] = np.nan  # blocks of two bins: the second has one of fluid
    flow = Flow(("x", "y"), (64.0, 64.0), 2, velocity=velocity)
    mean = quiver.arrows(flow, Region((0.0, 0.0), (64.0, 64.0)))[2]
    assert np.isnan(mean[:, :2]).all() and np.isfinite(mean[:, 2:]).all()
