"""Where a displacement is a straight line, and the error bar of its slope."""

import numpy as np
import pytest

from mesokit import Box, Case, MeanSquareDisplacement, Run, Simulation
from mesokit.method.brownian import Brownian
from mesokit.observe.mean_square_displacement import late_slope
from mesokit.seam.estimate import Estimate
from tests.helpers.fake_spheres import hard

LAGS = np.unique(np.round(np.geomspace(1, 4000, 90)))


def seen(law, longest, noise, seed):
    """A curve up to a lag, of 32 groups whose slopes scatter from octave to octave."""
    time = LAGS[longest >= LAGS]
    rng, widths = np.random.default_rng(seed), np.diff(time, prepend=0.0)
    steps = rng.normal(size=(32, len(time))) * np.sqrt(widths * time) * noise
    groups = law(time) + np.cumsum(steps, axis=1)
    value = groups.mean(axis=0)
    return time, Estimate(value, (groups - value) / 32, np.ones_like(groups))


def flight(memory, D=0.7):
    """2 D t beyond free flight."""
    return lambda t: 2 * D * (t + memory * np.expm1(-t / memory))


@pytest.mark.parametrize("memory", [3.0, 20.0, 80.0])
def test_it_begins_beyond_free_flight(memory):
    """Though nothing says how long that lasts: few starts are off by more than two errors."""
    off = []
    for seed in range(40):
        found = late_slope(*seen(flight(memory), 4000, 0.02, seed), 0.0)
        assert found.straight and np.isnan(found.line[memory / 2 > LAGS]).all()
        assert np.isfinite(found.line[LAGS >= 2000]).all()
        off.append((found.value - 1.4) / found.error)
    assert np.mean(np.abs(off) > 2) < 0.2  # 0.05 for normal numbers
    assert 0.6 < np.sqrt(np.mean(np.square(off))) < 1.4


def test_of_a_straight_line_all_of_it_counts():
    starts, errors = [], []
    for seed in range(60):
        found = late_slope(*seen(lambda t: 1.4 * t, 4000, 0.02, seed), 0.0)
        starts.append(np.flatnonzero(np.isfinite(found.line))[0])
        errors.append((found.value - 1.4) / found.error)
    assert np.mean(np.array(starts) == 0) > 0.7
    assert 0.7 < np.sqrt(np.mean(np.square(errors))) < 1.2  # 10 % of chance


def test_too_short_for_diffusion_it_says_so():
    found = late_slope(*seen(flight(500.0), 200, 0.001, 1), 0.0)
    assert not found.straight and found.error > 0.5 * found.value
    assert late_slope(*seen(flight(5.0), 2, 0.001, 1), 0.0) is None


@pytest.mark.parametrize("seed", range(5))
def test_what_grows_with_the_lag_agrees_whatever_the_longest_lag(seed):
    """A slope of 0.3 + 0.05 ln t: the error bar holds a decade of it."""
    fits = [
        late_slope(*seen(lambda t: t * (0.25 + 0.05 * np.log(t)), longest, 1e-3, seed), 5.0, True)
        for longest in (100, 400, 2000)
    ]
    for found in fits:
        assert found.growth == pytest.approx(0.05 * np.log(10), rel=0.3)
        assert abs(found.value - fits[-1].value) < 2 * np.hypot(found.error, fits[-1].error)


def coefficient(case, steps):
    simulation = Simulation(case, threads=1)
    simulation.run(steps)
    return simulation["mean-square-displacement"]["diffusion coefficient"]


def test_disks_among_others_are_said_to_diffuse_ever_faster():
    observe = MeanSquareDisplacement(every=2, max_lag=60)
    case = hard([observe], (25, 25), number=None, packing_fraction=0.4, timestep=0.2)
    found = coefficient(case, 300)
    assert "grows with the lag" in found.note and found.approximate
    assert found.error > 0.03 * found.measured
    run = Run(1, method="brownian")
    free = Case(run=run, box=Box([9, 9]), observe=[observe], brownian=Brownian(density=3))
    found = coefficient(free, 400)
    assert "lag" not in found.note and abs(found.deviation) < 4
