"""Error bars of sizes and bonds in runs that are no longer than a molecule relaxes."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import SRD, BondLength, Harmonic, MaxwellBoltzmann, MoleculeSize, Stress
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.observe.shared.tensor import kept
from mesokit.observe.shared.short_run import ENOUGH
from tests.helpers.small_fluids import make_case
from tests.helpers.whole_fluid import AtOnce

MOLECULES, RUNS, INTERVAL = 512, 80, 0.1
DIMERS = {
    "density": 2.0,
    "timestep": INTERVAL,
    "collision": SRD(),
    "thermostat": MaxwellBoltzmann(),
    "molecule": Molecule(bond=Harmonic(K=1 / 6)),
}


class Dimers(AtOnce):
    """Bond vectors that relax as theory says, each on its own, and start in equilibrium."""

    def __init__(self, accumulator, seed):
        self.random = np.random.default_rng(seed)
        self.keep = np.exp(-INTERVAL / accumulator.times.mode[0])  # the time between two samples
        self.bonds = self.random.normal(scale=np.sqrt(3), size=(MOLECULES, 3))

    def advance(self):
        noise = self.random.normal(scale=np.sqrt(3 * (1 - self.keep**2)), size=self.bonds.shape)
        self.bonds = self.keep * self.bonds + noise

    def bond_vectors(self):
        return self.bonds

    def whole_positions(self, ids=None):
        return np.stack([-self.bonds / 2, self.bonds / 2], axis=1).reshape(-1, 3)


def measured(kind, samples, seed):
    observable = kind(every=1)
    accumulator = observable.accumulator(make_case((8, 8, 8), [observable], **DIMERS))
    fluid = Dimers(accumulator, seed)
    for _ in range(samples):
        accumulator.observe(fluid)
        fluid.advance()
    return accumulator


@pytest.mark.parametrize("kind", [BondLength, MoleculeSize])
@pytest.mark.parametrize("relaxations", [0.4, 1.5])
def test_error_bars_hold(kind, relaxations):
    """Of short runs too: deviations of many of them scatter as their error bars say."""
    time = measured(kind, 1, 0).times.mode[0]
    samples = max(5, round(relaxations * time / INTERVAL))
    deviation = []
    for seed in range(RUNS):
        compared = next(measured(kind, samples, seed).comparisons())
        deviation.append(compared.deviation)
        assert "lower bound" in str(compared)
    assert abs(np.std(deviation) - 1) < 3 / np.sqrt(2 * RUNS)


@pytest.mark.parametrize("relaxations", [0.4, 1.5])
def test_error_bars_of_the_pressure_hold(relaxations):
    observable = Stress(every=1)
    case = make_case((8, 8, 8), [observable], **DIMERS)
    time = measured(BondLength, 1, 0).times.mode[0]
    deviation = []
    for seed in range(RUNS):
        accumulator = observable.accumulator(case)
        fluid = Dimers(measured(BondLength, 1, seed), seed)
        for _ in range(round(relaxations * time / INTERVAL)):
            bonds = 2 / 6 * fluid.bonds.T @ fluid.bonds / case.box.volume
            flight = -case.fluid.density * np.eye(3)
            fluid.stress = {"kinetic": flight, "collisional": 0 * flight, "bond": bonds}
            accumulator.observe(fluid)
            fluid.advance()
        pressure = accumulator.result()["pressure"]
        assert pressure.expected == 1.0 and "lower bound" in pressure.note
        deviation.append(pressure.deviation)
    assert abs(np.std(deviation) - 1) < 3 / np.sqrt(2 * RUNS)


def test_a_long_run_has_the_error_bar_of_blocking():
    samples = round(1.1 * ENOUGH * measured(BondLength, 1, 0).times.mode[0] / INTERVAL)
    accumulator = measured(BondLength, samples, 3)
    result = accumulator.result()
    np.testing.assert_array_equal(result.error, accumulator.blocks.error())
    assert "lower bound" not in str(result.comparisons[0])


def test_what_it_remembers_goes_on_after_a_stop():
    first = measured(MoleculeSize, 30, 5)
    again = measured(MoleculeSize, 1, 6)
    again.restore(first.state())
    assert again.result() == first.result()


def test_part_of_the_variance_that_a_mean_keeps():
    assert kept(1e-4) == pytest.approx(1.0) and kept(100.0) == pytest.approx(0.0198)
    assert kept(0.9e-3) == pytest.approx(kept(1.1e-3), rel=1e-3)


def test_pooled_short_runs_have_the_error_bar_of_all_of_them():
    runs = [measured(BondLength, 40, seed) for seed in range(9)]
    alone = next(runs[0].comparisons()).error
    for other in runs[1:]:
        runs[0].pool(other)
    assert next(runs[0].comparisons()).error == pytest.approx(alone / 3, rel=0.3)
    assert runs[0].relaxations() == pytest.approx(runs[1].relaxations())
