"""How far the integral of the stress autocorrelation goes, and what is said of its error."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import FENE, WCA, Harmonic, MaxwellBoltzmann, StressAutocorrelation
from mesokit.method.mpcd.expected.rheometer import modes_of_stress
from mesokit.method.mpcd.molecule import Molecule
from tests.helpers.fake_fluid import FakeFluid


def dimers_at_rest(make_case, seed, steps, K=6.0, **observable):
    """Dimers whose bond stress forgets in the time of theory, with white noise; and theory."""
    molecule, seen = Molecule(length=2, bond=Harmonic(K=K)), StressAutocorrelation(**observable)
    case = make_case(
        (4, 4), [seen], density=10, timestep=0.1, molecule=molecule, thermostat=MaxwellBoltzmann()
    )
    accumulator, fluid = seen.accumulator(case), FakeFluid(case)
    modulus, (tau,), eta = modes_of_stress(case)
    rng, kept = np.random.default_rng(seed), np.exp(-0.1 / tau)
    bond = rng.normal(size=2) * np.sqrt(modulus / 16)
    for _ in range(steps):
        bond = kept * bond + np.sqrt((1 - kept**2) * modulus / 16) * rng.normal(size=2)
        x, y = bond + np.sqrt(20 * eta / 16) * rng.normal(size=2)
        fluid.stress = {"bond": np.array([[0, x], [y, 0]])}
        accumulator.observe(fluid)
    return modulus, tau, eta, accumulator.result()


def test_the_integral_does_not_end_in_noise_before_the_stress_time(make_case):
    """Nor does its error bar leave out what it would so not see."""
    deviations = []
    for seed in range(12):
        _, tau, _, result = dimers_at_rest(make_case, seed, 1500)
        (viscosity,) = result.comparisons
        lasts = result.x["time"][result.x["time"] <= 4 * tau].max()
        assert 1 / result.extra["frequency"][0] == pytest.approx(lasts)
        deviations.append((viscosity.measured - viscosity.expected) / viscosity.error)
    assert abs(np.mean(deviations)) < 4 / np.sqrt(12) and np.std(deviations) < 2


def test_a_cut_integral_is_called_a_lower_bound(make_case):
    """Cut by max_lag, theory is cut too; where no stress time is known, noise cuts it."""
    modulus, tau, eta, result = dimers_at_rest(make_case, 1, 400, K=0.5, max_lag=20)
    (viscosity,) = result.comparisons
    assert "lower bound: integral to t = 2 tau" in viscosity.note
    whole = eta + modulus * tau * (1 - np.exp(-2 / tau))
    assert viscosity.expected == pytest.approx(whole / 10)


def test_noise_that_cuts_an_integral_of_unknown_molecules_is_named(make_case):
    molecule = Molecule(length=2, bond=FENE(), pair=WCA())
    case = make_case((4, 4), [StressAutocorrelation()], density=10, timestep=0.1, molecule=molecule)
    accumulator, fluid = StressAutocorrelation().accumulator(case), FakeFluid(case)
    rng = np.random.default_rng(3)
    for _ in range(100):
        fluid.stress = {"bond": rng.normal(size=(2, 2))}
        accumulator.observe(fluid)
    (viscosity,) = accumulator.result().comparisons
    assert viscosity.note.startswith("lower bound: integral to t") and "noise" in viscosity.note
