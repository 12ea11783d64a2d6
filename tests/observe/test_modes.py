"""Transverse and longitudinal modes of linear hydrodynamics give back what went in."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import LongitudinalModes, TransverseModes
from mesokit.errors import CaseError
from mesokit.method.mpcd.observe.shared.modes import transverse_units
from tests.helpers.comparisons import comparisons
from tests.helpers.fake_fluid import FakeFluid, FakeWaves


def sampled(case, observable, samples, viscosity=0.8, speed=1.3, attenuation=0.9, seed=1):
    accumulator = observable.accumulator(case)
    waves = FakeWaves(
        case, accumulator.wavevectors, viscosity, speed, attenuation, accumulator.interval(), seed
    )
    for _ in range(samples):
        waves.advance()
        accumulator.observe(waves)
    return accumulator


def test_transverse_modes_give_the_viscosity(make_case):
    case = make_case((12, 12, 12))
    result = sampled(case, TransverseModes(every=5), 12000).result()
    viscosities = comparisons(result, "viscosity")
    assert len(viscosities) == 2  # the third wave decays within a few samples
    for found in viscosities:
        assert abs(found.measured - 0.8) < 4 * found.error, str(found)
        assert found.error < 0.025
    equipartition = result.comparisons[-1]
    assert abs(equipartition.deviation) < 4


def test_error_of_the_viscosity_is_that_of_repeated_runs(make_case):
    case = make_case((12, 12, 12))
    found = [
        sampled(case, TransverseModes(every=5, waves=[[0, 1, 0]]), 1500, seed=seed)
        .result()
        .comparisons[0]
        for seed in range(24)
    ]
    spread = np.std([c.measured for c in found], ddof=1)
    quoted = np.sqrt(np.mean([c.error**2 for c in found]))
    assert 0.6 < quoted / spread < 1.7
    # no estimate of the decay rate gamma of n real signals beats sqrt(2 gamma/(n T))
    rate, total = 0.8 * (2 * np.pi / 12) ** 2, 1500 * 0.5
    best = np.sqrt(2 / (rate * total * 4)) * 0.8
    assert spread < 1.8 * best


def test_longitudinal_modes_give_sound(make_case):
    case = make_case((20, 20, 20))
    result = sampled(case, LongitudinalModes(every=5), 12000).result()
    speeds = comparisons(result, "sound speed")
    dampings = comparisons(result, "sound att")
    assert len(speeds) == len(dampings) == 3
    for found in speeds:
        assert abs(found.measured - 1.3) < 4 * found.error and found.error < 0.02, str(found)
    for found in dampings:
        assert abs(found.measured - 0.9) < 4 * found.error and found.error < 0.08, str(found)


def test_expected_sound_is_the_law_of_the_fake(make_case):
    case = make_case((20, 20, 20))
    accumulator = sampled(case, LongitudinalModes(every=5, max_lag=200), 8000)
    result = accumulator.result()
    k = accumulator.wavenumbers[0]
    expected = accumulator.sound(result.x["time"], k, 1.3, 0.9)
    assert np.abs(result.value[:, 0] - expected).max() < 0.1
    assert np.abs(result.value[:10, 0] - expected[:10]).max() < 0.02


def test_amplitudes_of_particles(make_case):
    case = make_case((8, 8, 8), density=5)
    accumulator = TransverseModes(waves=[[1, 0, 0], [1, 1, 0], [0, 1, 0]]).accumulator(case)
    fluid = FakeFluid(case)
    for _ in range(200):
        fluid.jump(10)
        accumulator.observe(fluid)
    result = accumulator.result()
    assert result.x["wavenumber"] == pytest.approx([np.pi / 4, np.pi / 4 * 2**0.5])
    assert abs(result.comparisons[-1].deviation) < 4
    assert np.abs(result.value[1:5]).max() < 0.15  # every sample is a new fluid


def test_polarisations_are_orthonormal():
    for k in np.random.default_rng(1).normal(size=(20, 3)):
        frame = np.vstack([transverse_units(k), k / np.linalg.norm(k)])
        assert frame @ frame.T == pytest.approx(np.eye(3), abs=1e-12)


def test_waves_that_do_not_fit(make_case):
    from mesokit import Plates

    for wrong in ([[1, 0, 0]], [[0, 0]]):
        with pytest.raises(CaseError, match="expected 2 whole numbers"):
            make_case((8, 8), [TransverseModes(waves=wrong)])
    with pytest.raises(CaseError, match="which a wall closes"):
        make_case((8, 8), [TransverseModes(waves=[[0, 1]])], walls=[Plates(axis="y")])
    with pytest.raises(CaseError, match="sliding images"):
        make_case((8, 8), [TransverseModes()], shear_rate=0.1)
