"""What a fluid at rest relaxes to: Maxwell velocities, equipartition, an ideal gas."""

import numpy as np
import pytest
from scipy import stats

from mesokit import theory
from mesokit.method.mpcd.fluid import Species
from tests.helpers.small_fluids import COLLIDING, Measured, cells, make_fluid, mean

UNLIKELY = 1e-3  # a p-value below this would happen by chance once in a thousand seeds


@pytest.mark.parametrize("rule", COLLIDING, ids=lambda rule: rule.__name__)
def test_velocities_become_maxwellian(rule):
    size, density = (8, 8, 8), 10
    random = np.random.default_rng(5)
    v = random.uniform(-np.sqrt(3), np.sqrt(3), (density * 512, 3))  # the variance of kT = m = 1
    v -= v.mean(axis=0)
    v *= np.sqrt(1 / np.mean(v**2))
    fluid = make_fluid(size, collision=rule(), density=density, velocities=v)
    flat = stats.kstest(fluid.velocities().ravel(), theory.maxwell_component_cdf)
    fluid.advance(200)
    v = fluid.velocities()
    assert flat.pvalue < 1e-10  # the test can tell
    assert stats.kstest(v.ravel(), theory.maxwell_component_cdf).pvalue > UNLIKELY
    speed = np.linalg.norm(v, axis=1)
    assert stats.kstest(speed, theory.maxwell_speed_cdf, args=(3,)).pvalue > UNLIKELY


@pytest.mark.parametrize("rule", COLLIDING, ids=lambda rule: rule.__name__)
def test_heavy_and_light_particles_share_the_energy(rule):
    kinds = (Species(mass=1, density=5), Species(mass=4, density=5))
    fluid = make_fluid((24, 24), collision=rule(), species=kinds)
    v, heavy = fluid.velocities(), fluid.species() == 1
    v[heavy] *= np.sqrt(0.2)  # total energy as at kT = 1, very unevenly shared
    v[~heavy] *= np.sqrt(1.8)
    v -= (fluid.masses() @ v) / fluid.masses().sum()
    fluid = make_fluid((24, 24), collision=rule(), species=kinds, velocities=v)
    momentum = fluid.totals()[1]
    fluid.advance(400)
    samples = []
    for _ in range(20):
        fluid.advance(20)
        energy = fluid.masses()[:, None] * fluid.velocities() ** 2
        samples.append([energy[heavy].mean(), energy[~heavy].mean()])
    assert abs(fluid.totals()[1] - momentum).max() < 1e-8
    # Every snapshot is 2 N_kind numbers of variance 2; snapshots 20 collisions apart are new.
    error = np.sqrt(2 / (2 * heavy.sum() * len(samples)))
    # A rule that restores angular momentum by scaling to the old energy is not exactly stationary,
    # and rotations that favour a direction know no detailed balance.
    systematic = 0.005 if rule.one_temperature else 0.04
    for value in np.mean(samples, axis=0):
        assert Measured(value, error).agrees(1.0, systematic=systematic), value


@pytest.fixture(scope="module")
def quiet_fluid():
    """Occupations and stress of a fluid at rest in a box that is no cube."""
    fluid = make_fluid((14, 16, 12), density=10, measures=("stress",))
    occupations, pressures, collisional = [], [], []
    for _ in range(40):
        fluid.advance(10)
        for _ in range(5):
            fluid.advance(1, measure=["stress"])
            parts = {name: np.trace(tensor) / 3 for name, tensor in fluid.stress.items()}
            pressures.append(-parts["kinetic"] - parts["collisional"])
            collisional.append(-parts["collisional"])
        occupations.append(np.bincount(cells(fluid), minlength=14 * 16 * 12))
    kT = 2 * fluid.totals()[2] / (3 * fluid.n)
    return np.array(occupations), np.array(pressures), np.array(collisional), kT


def test_cell_occupation_is_poissonian(quiet_fluid):
    counts = quiet_fluid[0][::10].ravel()  # snapshots 150 steps apart
    edges = np.arange(3, 19)
    observed = np.bincount(np.clip(counts, 2, 19), minlength=20)[2:20]
    p = np.concatenate([[stats.poisson.cdf(2, 10)], stats.poisson.pmf(edges, 10)])
    expected = np.append(p, 1 - p.sum()) * len(counts)
    assert stats.chisquare(observed, expected).pvalue > UNLIKELY
    dispersion = Measured(counts.var() / 10, np.sqrt(2 / len(counts)))
    assert dispersion.agrees(1.0), dispersion


def test_pressure_is_that_of_an_ideal_gas(quiet_fluid):
    """Of its own temperature: what it starts with it keeps, and that is off by chance."""
    _, pressure, collisional, kT = quiet_fluid
    blocks = [part.reshape(-1, 5).mean(axis=1) for part in (pressure, collisional)]
    assert abs(kT - 1) < 4 * np.sqrt(2 / (3 * 10 * 14 * 16 * 12))
    assert mean(blocks[0]).agrees(10.0 * kT), mean(blocks[0])
    assert mean(blocks[1]).agrees(0.0), mean(blocks[1])
