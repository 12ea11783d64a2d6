"""Spheres that start at random places in a part of the box: all of each lies within."""

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    CaseError,
    HardSpheres,
    Plates,
    RandomStart,
    Rectangle,
    RigidSpheres,
    Run,
    Simulation,
    SphereKind,
)

BLOCK = Rectangle(centre=[10, 20], size=[4, 4])
SECTIONS = {"event-driven": HardSpheres, "contact-dynamics": RigidSpheres}


def started(method, size, region, number, walls=()):
    """The engine of disks or spheres that start in a region."""
    kinds = [SphereKind(1.0, spread=0.2)]
    spheres = SECTIONS[method](number=number, kinds=kinds, start=RandomStart(region=region))
    run = Run(0, method=method)
    return Simulation(Case(run, Box(size), spheres=spheres, walls=walls), threads=1).engine


@pytest.mark.parametrize(
    ("method", "size", "region", "number", "walls"),
    [
        ("event-driven", [20, 40], [[0, 20], [10, 25]], 200, []),
        ("event-driven", [9, 20, 9], [[1, 8], [4, 14], [0, 9]], 200, [Plates("y")]),
        ("contact-dynamics", [20, 40], [[5, 15], [10, 30]], 60, [Plates("y"), BLOCK]),
    ],
    ids=["across a periodic axis", "in space", "beside a solid"],
)
def test_all_of_each_lies_in_the_region(method, size, region, number, walls):
    engine = started(method, size, region, number, walls)
    low, high = np.array(region, float).T
    inner = (low > 0) | (high < np.array(size))
    places, radii = engine.positions(), 0.5 * engine.diameters()[:, None]
    assert (places - radii - low)[:, inner].min() > -1e-9
    assert (high - places - radii)[:, inner].min() > -1e-9
    # and they fill it: the middle of all is that of the region, but for chance
    off = (places.mean(axis=0) - 0.5 * (low + high))[inner] / (high - low)[inner]
    assert np.abs(off).max() < 4 * np.sqrt(1 / 12 / number)


@pytest.mark.parametrize(
    ("region", "words"),
    [
        ([[0, 20]], r"spheres\.start\.region = \[\[0, 20\]\]: expected \[from, to\]"),
        ([[0, 30], [0, 10]], r"0 <= from < to <= 20 along x; not \[0, 30\]"),
        ([[5, 4], [0, 10]], r"along x; not \[5, 4\]"),
    ],
)
def test_wrong_regions_are_refused(region, words):
    with pytest.raises(CaseError, match=words):
        started("event-driven", [20, 40], region, 20)


def test_a_region_that_is_too_small_is_told():
    with pytest.raises(CaseError, match="they jam before they fill"):
        started("event-driven", [20, 40], [[0, 10], [0, 10]], 140)
