"""Starts of rigid grains from arrays: overlaps, which stay, and the step of fast ones."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from mesokit import Box, Case, CaseError, Plates, RigidSpheres, Run
from mesokit.seam.method import method_of

APART = np.array([[2.0, 2.0], [4.0, 2.0], [6.0, 2.0]])


def prepared(positions=APART, velocities=None, walls=(), **spheres):
    """The case as it starts from these places, without a run."""
    section = RigidSpheres(number=len(positions), **spheres)
    case = Case(Run(10, method="contact-dynamics"), Box([9, 9]), spheres=section, walls=walls)
    arrays = {"positions": positions}
    if velocities is not None:
        arrays["velocities"] = velocities
    return method_of(case).initial.prepared(case, arrays)


def near(depth):
    """Three grains of which the last two overlap so far."""
    return APART + [[0, 0], [0, 0], [-1 - depth, 0]]


def test_small_overlaps_are_accepted():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        prepared(near(0.009))


def test_larger_ones_are_warned_of():
    with pytest.warns(UserWarning, match="spheres 1 and 2 overlap by 0.05 diameters, which stays"):
        prepared(near(0.05))


def test_deep_ones_are_refused():
    with pytest.raises(CaseError, match=r"positions: spheres 1 and 2 overlap by 0.11 .*push_back"):
        prepared(near(0.11))


@pytest.mark.parametrize("axis", ["x", "y"])
def test_those_with_plates_count(axis):
    places = APART.copy()
    places[1, "xy".index(axis)] = 8.7
    with pytest.raises(CaseError, match=r"sphere 1 and a plate overlap by 0\.2 diameters"):
        prepared(places, walls=[Plates(axis)])


def test_those_across_the_box_count():
    with pytest.raises(CaseError, match=r"spheres 0 and 2 overlap by 0\.2"):
        prepared(np.array([[0.1, 2.0], [4.0, 2.0], [8.3, 2.0]]))


def test_overlaps_that_are_taken_back_are_accepted():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        prepared(near(0.5), push_back=0.1)


def test_fast_grains_have_short_steps():
    slow = prepared(velocities=0.0 * APART).spheres
    fast = prepared(velocities=[[300.0, 0], [0, 0], [0, 0]]).spheres
    given = prepared(velocities=[[300.0, 0], [0, 0], [0, 0]], timestep=0.01).spheres
    # 0.8 of the time in which two of them pass the skin of a quarter of a diameter
    assert fast.timestep == pytest.approx(0.8 * 0.25 / (2 * 300))
    assert slow.timestep is None and given.timestep == 0.01
