"""Ideal molecules between two walls: known cases, and molecules that are drawn."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import erf

from mesokit.method.mpcd.topology import bonds
from mesokit.theory import beads_in_slit, centre_in_slit

HEIGHT = 6.0
EDGES = np.linspace(0, HEIGHT, 25)


def binned(function):
    found = np.array([quad(function, *pair)[0] for pair in pairwise(EDGES)])
    return found / found.mean()


@pytest.mark.parametrize("spread", [0.1, 0.7, 3.0])
def test_dimers_are_error_functions(spread):
    width = spread * np.sqrt(2)
    bead = binned(lambda y: erf((HEIGHT - y) / width) + erf(y / width))
    centre = binned(lambda y: erf(2 * min(y, HEIGHT - y) / width))
    for found in beads_in_slit(EDGES, [(0, 1)], spread):
        np.testing.assert_allclose(found, bead, atol=1e-9)
    np.testing.assert_allclose(centre_in_slit(EDGES, [(0, 1)], spread), centre, atol=2e-4)


def test_long_chains_are_the_ground_state():
    """The middle of a chain that fills the slit: 2 sin^2(pi y/H)."""
    found = beads_in_slit(EDGES, bonds("chain", 1001), 0.15)[500]
    edge = 0.58 * 0.15  # the density of steps vanishes this far behind a wall (Milne's problem)
    wide = HEIGHT + 2 * edge
    expected = binned(lambda y: np.sin(np.pi * (y + edge) / wide) ** 2)
    np.testing.assert_allclose(found, expected, atol=0.01)


@pytest.mark.parametrize(
    ("topology", "length", "arms"), [("chain", 6, 1), ("star", 7, 3), ("ring", 5, 1)]
)
def test_it_is_that_of_molecules_that_are_drawn(topology, length, arms):
    """Gaussian molecules anywhere, weighted by a force, without those that reach into a wall."""
    rng, links, spread, decay = np.random.default_rng(7), bonds(topology, length, arms), 0.7, 0.1
    y = np.zeros((300_000, length))
    y[:, 0] = rng.random(len(y)) * HEIGHT
    steps = spread * rng.standard_normal((len(links), len(y)))
    if topology == "ring":
        steps -= steps.mean(axis=0)
    for step, (a, b) in zip(steps, links[: length - 1], strict=False):
        y[:, b] = y[:, a] + step
    y = y[((y > 0) & (y < HEIGHT)).all(axis=1)]
    weight = np.exp(decay * (y - HEIGHT).sum(axis=1))

    def compared(places, expected):
        bins = np.minimum((places / HEIGHT * 24).astype(int), 23)
        total = np.bincount(bins, weight, 24)
        error = np.sqrt(np.bincount(bins, weight**2, 24)) / total.mean()
        assert (np.abs(total / total.mean() - expected) < 4.5 * error + 1e-4).all()

    for bead, density in enumerate(beads_in_slit(EDGES, links, spread, decay)):
        compared(y[:, bead], density)
    if topology == "ring":
        with pytest.raises(ValueError, match="a ring"):
            centre_in_slit(EDGES, links, spread, decay)
    else:
        compared(y.mean(axis=1), centre_in_slit(EDGES, links, spread, decay))


def test_wide_slits_are_refused():
    with pytest.raises(ValueError, match=r"spread = 0\.001: expected more than"):
        beads_in_slit(EDGES, [(0, 1)], 0.001)
