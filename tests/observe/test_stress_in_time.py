"""Stress in time: windows, folding onto a period, error bars, pooling, theory."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from mesokit import (
    CaseError,
    Harmonic,
    MaxwellBoltzmann,
    Molecule,
    OscillatingShear,
    Run,
    StartUp,
    StressInTime,
)
from mesokit.case.box import Box
from mesokit.method.mpcd.expected.molecules import springs_in, without_bonds
from tests.helpers.fake_fluid import FakeFluid

OBSERVE = StressInTime(window=10)
SPRING = Molecule(length=2, bond=Harmonic(K=0.5))
DIMERS = {"density": 10.0, "thermostat": MaxwellBoltzmann(), "molecule": SPRING}


@pytest.fixture
def sheared(make_case):
    """A case with this history."""

    def make(history, steps, **fluid):
        case = make_case((4, 4), timestep=0.1, **fluid)
        box, run = Box((4, 4), shear=history), Run(steps=steps)
        return dataclasses.replace(case, box=box, run=run, observe=[OBSERVE])

    return make


def measured(case, steps, stress, seed=1, noise=0.0):
    """The accumulator after steps of a known stress, of a fluid that drifts as a whole."""
    accumulator, fluid = OBSERVE.accumulator(case), FakeFluid(case)
    drift = np.array([0.3, 0.2])
    fluid.totals = lambda: (fluid.n, fluid.m.sum() * drift, 0.0)
    carried = fluid.m.sum() / case.box.volume * np.outer(drift, drift)
    rng = np.random.default_rng(seed)
    for step in range(1, steps + 1):
        fluid.step = step
        whole = np.zeros((2, 2))
        whole[0, 1], whole[0, 0] = stress(step), 0.5 * stress(step)
        whole[0, 1] += noise * rng.normal()
        shares = (0.2, 0.1, 0.7) if accumulator.bonded else (0.25, 0.75)
        names = ("kinetic", "collisional", "bond")
        fluid.stress = {name: x * whole for name, x in zip(names, shares, strict=False)}
        fluid.stress["kinetic"] -= carried
        accumulator.observe(fluid)
    return accumulator


def test_periods_are_folded_and_give_the_error_bars(sheared):
    case, noise, periods = sheared(StartUp(0.1, start=2.0, period=6.0), 60 * 400), 0.3, 400
    found = measured(case, 60 * periods, lambda step: (step - 1) % 60 // 10, noise=noise).result()
    np.testing.assert_allclose(found.x["time"], np.arange(6) + 0.5)
    np.testing.assert_allclose(found.value[:, 1], 0.5 * np.arange(6))  # sigma_xx - sigma_yy
    error = noise / np.sqrt(10 * periods)
    assert found.error[:, 0] == pytest.approx(error, rel=0.35)
    assert (abs(found.value[:, 0] - np.arange(6)) < 4.5 * error).all()
    np.testing.assert_allclose(found.extra["rate"], [0, 0, 0.1, 0.1, 0.1, 0.1], atol=1e-12)


def test_without_a_period_other_runs_give_the_error_bars(sheared):
    case = sheared(StartUp(0.1, start=2.0), 65)  # the last window is not whole
    one, *others = (measured(case, 65, lambda step: step, seed, noise=1.0) for seed in range(12))
    assert np.isnan(one.result().error).all() and not one.result().comparisons
    for other in others:
        one.pool(other)
    found = one.result()
    assert found.value.shape == (6, 2) and found.samples == 12 * 65
    assert found.error[:, 0].mean() == pytest.approx(1 / np.sqrt(120), rel=0.4)
    assert (abs(found.value[:, 0] - (np.arange(6) * 10 + 5.5)) < 0.5).all()


def test_a_run_may_become_longer(sheared):
    history = StartUp(0.1, start=2.0)
    short = measured(sheared(history, 30), 30, lambda step: step)
    longer = OBSERVE.accumulator(sheared(history, 60))
    longer.restore(short.state())
    assert len(longer.result().value) == 3 and longer.rows == 6
    assert len(measured(sheared(history, 30), 55, lambda step: step).result().value) == 5


def test_theory_is_the_factor(sheared):
    """A stress that is 0.9 times that of theory, in each period, reads 0.9; and none if it is not
    known what came before."""
    history, tau = StartUp(0.1, start=4.0, period=12.0), 120
    case = sheared(history, 10 * tau, **DIMERS)
    assert OBSERVE.accumulator(case).components[1] == "shear stress of bonds"
    expected = measured(case, 10 * tau, lambda step: 1.0).result().expected
    windows = np.repeat(expected[:, 0], 10)
    found = measured(case, 10 * tau, lambda step: 0.9 * windows[(step - 1) % tau], noise=1e-3)
    assert found.result()["shear stress over theory"].measured == pytest.approx(0.9, abs=1e-3)
    # rest and shear in turn: what is left of one period is in the next
    viscosity = without_bonds(case).viscosity
    jump = expected[4, 0] - expected[3, 0]
    assert jump == pytest.approx(viscosity * 10 * 0.1, rel=0.5)
    assert expected[0, 0] > 0.05 and (np.diff(expected[:4, 0]) < 0).all()


def test_few_repetitions_that_agree_are_not_exact(sheared):
    """Springs fluctuate, and a factor to theory with them: as often as its error bar says."""
    case = sheared(StartUp(0.1, start=4.0, period=12.0), 4 * 120, **DIMERS)
    agreeing = measured(case, 4 * 120, lambda step: 1.0).result()
    quoted = agreeing["shear stress over theory"].error
    assert (agreeing.error > 0).all()
    [(number, times)] = springs_in(case)
    theory, rng = np.repeat(agreeing.expected[:, 0], 10), np.random.default_rng(4)
    kept = np.exp(-0.1 / float(times.stress[0]))
    noise = np.sqrt(number) / case.box.volume * rng.normal(size=(1000, 4))
    factors = np.zeros((1000, 4))
    for line in theory:
        fresh = np.sqrt(number * (1 - kept**2)) / case.box.volume * rng.normal(size=noise.shape)
        noise = kept * noise + fresh
        factors += noise * line / 10 / (agreeing.expected[:, 0] ** 2).sum()
    assert factors.mean(axis=1).std() == pytest.approx(quoted, rel=0.1)


@pytest.mark.parametrize(
    ("history", "words"),
    [
        (StartUp(0.1, period=2.5), "window = 10: expected a divisor of 25"),
        (StartUp(0.1, period=2.03), "expects whole timesteps of 0.1"),
    ],
)
def test_windows_fit_the_period(sheared, history, words):
    with pytest.raises(CaseError, match=words):
        OBSERVE.check(sheared(history, 10))


def test_an_oscillation_whose_period_is_no_whole_step_is_not_folded(sheared):
    assert OBSERVE.accumulator(sheared(OscillatingShear(0.1, 1.0), 50)).period is None
    with pytest.raises(CaseError, match="multiple of every = 3"):
        StressInTime(window=10, every=3).check(sheared(None, 10))


def test_nothing_is_known_before_a_period_is_over(sheared):
    """What has begun is no period yet."""
    case = sheared(StartUp(0.1, start=2.0, period=6.0), 40, **DIMERS)
    [said] = OBSERVE.warnings(case)
    assert "no whole period of the shear (60 steps)" in said
    result = measured(case, 30, lambda step: 1.0).result()
    assert result.value.shape == (0, 3) and result.comparisons == ()


def test_a_warm_up_leaves_out_windows_and_shifts_none(sheared):
    """Windows that no sample has seen are missing; the others keep their times and values."""
    case = sheared(StartUp(rate=0.2), 30)
    case = dataclasses.replace(case, run=Run(steps=30, warmup=20))
    accumulator, fluid = OBSERVE.accumulator(case), FakeFluid(case)
    fluid.totals = lambda: (fluid.n, np.zeros(2), 0.0)
    for step in range(21, 51):
        fluid.step, whole = step, np.zeros((2, 2))
        whole[0, 1] = step // 10
        fluid.stress = {"kinetic": 0.25 * whole, "collisional": 0.75 * whole}
        accumulator.observe(fluid)
    result = accumulator.result()
    shear = result.value[:, 0]
    np.testing.assert_allclose(shear, [2.1, 3.1, 4.1], rtol=1e-12)  # the last step belongs to both
    np.testing.assert_allclose(result.x["time"], [2.5, 3.5, 4.5])
