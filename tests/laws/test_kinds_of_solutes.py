"""Kinds of solutes with masses and potentials of their own: mechanics and equilibrium."""

import dataclasses

import numpy as np
import pytest

from tests.helpers.kinds_of_fluid import SEVERAL_KINDS as MIXTURE
from tests.helpers.small_fluids import make_fluid, mean

pytestmark = pytest.mark.long

SIZE = (12, 12)


def mixture(refine=1, **parts):
    finer = dataclasses.replace(MIXTURE, substeps=refine * MIXTURE.substeps)
    return make_fluid(SIZE, solutes=finer, density=4, **parts)


@pytest.fixture(scope="module")
def settled():
    """In equilibrium, of an energy that it keeps."""
    fluid = mixture()
    fluid.advance(150)
    return fluid


def pair_energy(r, epsilon, sigma):
    sixth = (sigma / r) ** 6
    return np.where(r < 2 ** (1 / 6) * sigma, 4 * epsilon * (sixth**2 - sixth) + epsilon, 0.0)


def energy(places):
    """Of all bonds, angles and pairs, from the formulas, of all pairs of beads."""
    chains, rings = places[:20].reshape(4, 5, 2), places[20:32].reshape(3, 4, 2)
    bonds = np.diff(chains, axis=1)
    found = 2.0 * (bonds**2).sum()
    lengths = np.linalg.norm(bonds, axis=2)
    cosine = (bonds[:, 1:] * bonds[:, :-1]).sum(axis=2) / (lengths[:, 1:] * lengths[:, :-1])
    found += 3.0 * (1 - cosine).sum()
    sides = np.linalg.norm(np.roll(rings, -1, axis=1) - rings, axis=2)
    found += 15.0 * ((sides - 0.7) ** 2).sum()
    way = places[:, None] - places[None]
    way -= 12 * np.rint(way / 12)
    r = np.linalg.norm(way, axis=2) + 1e9 * np.eye(40)
    kind = np.repeat([0, 1, 2], [20, 12, 8])
    rules = {(1, 1): (1, 0.5), (2, 2): (2, 1.3), (1, 2): (np.sqrt(2), 0.9), (0, 2): (1, 0.8)}
    for (a, b), (epsilon, sigma) in rules.items():
        part = pair_energy(r[np.ix_(kind == a, kind == b)], epsilon, sigma).sum()
        found += part * (0.5 if a == b else 1.0)
    return found


def test_every_kind_feels_what_it_should(settled):
    """Given, mixed and missing potentials, of two classes of bonds: the energy of the formulas."""
    assert settled.potential_energy() == pytest.approx(energy(settled.solutes.places), rel=1e-12)


def test_forces_are_minus_the_gradient_of_that_energy():
    """The error of the total energy falls with the square of the sub-step."""
    changes = []
    for refine in (1, 2, 4):
        fluid = mixture(refine)
        first, worst = fluid.totals()[2] + fluid.potential_energy(), 0.0
        for _ in range(8):
            fluid.advance(1)
            now = fluid.totals()[2] + fluid.potential_energy()
            worst = max(worst, abs(now - first))
        changes.append(worst / 40)
    assert changes[0] < 0.02
    assert changes[1] < 0.4 * changes[0] and changes[2] < 0.4 * changes[1]


def test_momentum_is_kept_to_rounding(settled):
    assert abs(settled.totals()[1]).max() < 1e-9 * settled.n


def test_every_kind_has_the_temperature(settled):
    """Of masses 2, 5 and 20; less the share that a whole at rest takes from each bead."""
    kind, mass = settled.solutes.kinds(), settled.solutes.masses()
    whole = mass.sum() + settled.n
    found = []
    for _ in range(300):
        settled.advance(5)
        square = mass * (settled.solutes.velocities**2).sum(axis=1) / (1 - mass / whole)
        number, _, energy = settled.totals()
        of_all = energy / (number - 1)
        found.append([square[kind == k].mean() / 2 / of_all for k in range(3)])
    for values in np.transpose(found):
        blocks = mean(values.reshape(30, -1).mean(axis=1))
        assert blocks.agrees(1.0) and blocks.error < 0.04
