"""Rigid grains in a box whose images slide (Lees and Edwards 1972)."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import RandomStart, SphereKind
from tests.helpers.rigid_grains import exact, rigid

SIZE, RATE = 8.0, 0.4


def sheared_box(given=None):
    spheres = {"packing_fraction": 0.7} if given is None else {}
    return rigid(
        [SIZE, SIZE], box={"shear_rate": RATE}, timestep=0.01, given=given, **spheres,
        kinds=[SphereKind(1.0, spread=0.2)], start=RandomStart(), contact={"friction": 0.4},
        solver=exact(tolerance=1e-9),
    )  # fmt: skip


@pytest.fixture(scope="module")
def sheared():
    return sheared_box()


def test_the_start_flows_as_the_box_does(sheared):
    height = sheared.positions()[:, 1] - SIZE / 2
    expected = np.stack([RATE * height, 0 * height], axis=1)
    assert sheared.velocities() == pytest.approx(expected, abs=1e-12)


def test_no_height_of_a_sheared_box_differs_from_another(sheared):
    """Grains half a box higher, in the flow of that height, move as before."""
    places, velocities = sheared.positions(), sheared.velocities()
    spins = np.zeros(sheared.n)
    low = sheared_box({"positions": places, "velocities": velocities, "spins": spins})
    places, velocities = places + [0, SIZE / 2], velocities + [RATE * SIZE / 2, 0]
    beyond = places[:, 1] >= SIZE
    places[beyond, 1] -= SIZE
    velocities[beyond, 0] -= RATE * SIZE
    high = sheared_box({"positions": places, "velocities": velocities, "spins": spins})
    for engine in (low, high):
        engine.advance(50)
    assert np.abs(low.velocities()[:, 1]).max() > 0.1
    assert low.lost["friction"] > 0
    # rounding grows as grains collide
    assert high.velocities()[:, 1] == pytest.approx(low.velocities()[:, 1], abs=1e-6)
    assert high.spins() == pytest.approx(low.spins(), abs=1e-6)


def test_images_that_slide_keep_off_as_others_do(sheared):
    """No pair overlaps by more than the forces of the sweeps leave, across the box or within."""
    overlaps, pairs = np.zeros(2), np.zeros(2)
    for _ in range(8):
        sheared.advance(60)
        within, across = gaps(sheared)
        overlaps = np.maximum(overlaps, [-within.min(), -across.min()])
        pairs += [(within < 0.05).sum(), (across < 0.05).sum()]
    assert (pairs > 10).all()
    assert (overlaps < 1e-3).all()


def gaps(engine):
    """Gaps of pairs of grains, of those within the box and of those across its sliding images."""
    places, diameters = engine.positions(), engine.diameters()
    one, other = np.triu_indices(engine.n, 1)
    x, y = (places[one] - places[other]).T
    boxes = np.rint(y / SIZE)
    x -= boxes * RATE * SIZE * engine.time
    x -= SIZE * np.rint(x / SIZE)
    gap = np.hypot(x, y - SIZE * boxes) - 0.5 * (diameters[one] + diameters[other])
    return gap[boxes == 0], gap[boxes != 0]
