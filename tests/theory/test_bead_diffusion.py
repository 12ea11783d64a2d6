"""Diffusion of beads that collide with a fluid without memory, and with one another."""

import numpy as np
import pytest

from mesokit import theory


def by_collisions(dimension, density, turned, masses, places, pairs=60_000, steps=40, seed=1):
    """For how many steps the first of two beads at such places remembers its velocity, from
    collisions with drawn shifts and drawn numbers of particles of mass 1; mean and its error."""
    rng = np.random.default_rng(seed)
    own, other = masses
    v, w, total = np.ones(pairs), np.zeros(pairs), np.ones(pairs)
    for _ in range(steps):
        shift = rng.random((pairs, dimension))
        shared = (np.floor(places + shift) == np.floor(shift)).all(axis=1)
        first, second = rng.poisson(density, (2, pairs))
        both = (own * v + other * w) / (own + other + first)
        one, two = own * v / (own + first), other * w / (other + second)
        v, w = (
            (1 - turned) * a + turned * np.where(shared, both, b) for a, b in ((v, one), (w, two))
        )
        total += v
    return total.mean(), total.std() / pairs**0.5


@pytest.mark.parametrize(("dimension", "masses"), [(2, (4.0, 4.0)), (3, (8.0, 3.0))])
def test_of_another_bead_it_finds_what_that_hands_back(dimension, masses):
    """Friction by a crowd is that of pairs, here anywhere in a region of 2^d cells."""
    density, dt, crowd = 5.0, 0.1, 1e-6
    places = np.random.default_rng(7).uniform(-1, 1, (60_000, dimension))
    turned = 2 / dimension * (1 - np.cos(np.radians(130)))
    pair, error = by_collisions(dimension, density, turned, masses, places)
    given = ("srd", dimension, density, dt, 130.0, masses[0])
    alone = theory.bead_diffusion(*given)
    among = theory.bead_diffusion(*given, 1.0, 1.0, (crowd, masses[1]))
    unit = dt / masses[0]
    expected = 2**dimension * (unit * (pair - 0.5) - alone)  # of D, for one other bead per cell
    slope = (among - alone) / crowd
    assert slope == pytest.approx(expected, abs=4 * 2**dimension * unit * error)
    assert 2**dimension * unit * error < 0.04 * abs(slope)


def test_others_are_no_others_where_they_are_few_or_light():
    given = ("at", 3, 10.0, 0.1, None, 10.0)
    alone = theory.bead_diffusion(*given)
    assert theory.bead_diffusion(*given, 1.0, 1.0, (1e-9, 10.0)) == pytest.approx(alone)
    assert theory.bead_diffusion(*given, 1.0, 1.0, (0.1, 1e-4)) == pytest.approx(alone, rel=1e-4)
    with pytest.raises(ValueError, match="crowd"):
        theory.bead_diffusion(*given, 1.0, 1.0, (-0.1, 1.0))
