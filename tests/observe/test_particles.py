"""Displacement and memory of particles that obey molecular chaos exactly."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import (
    MaxwellBoltzmann,
    MeanSquareDisplacement,
    Plates,
    Uniform,
    VelocityAutocorrelation,
    theory,
)
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.displacement import Displacement
from mesokit.observe.shared.origins import Origins
from tests.helpers.comparisons import by_name, comparison
from tests.helpers.fake_fluid import FakeFluid


def watched(case, observable, kept, samples, seed=1):
    accumulator, fluid = observable.accumulator(case), FakeFluid(case, seed, kept=kept)
    accumulator.observe(fluid)
    for _ in range(samples):
        fluid.advance(observable.every)
        accumulator.observe(fluid)
    return accumulator.result()


def kept_by(case):
    fluid = case.fluid
    return 1 - theory.decorrelation_from_diffusion(
        setting.transport(case).diffusion, fluid.timestep, fluid.kT, fluid.mass
    )


# in 2D the flow that a particle stirs up makes D grow with the lag: the error bar holds a decade
@pytest.mark.parametrize(("size", "most"), [((12, 12), 0.2), ((6, 6, 6), 0.05)])
def test_displacement_and_diffusion(make_case, size, most):
    case = make_case(size, timestep=1.0)
    result = watched(case, MeanSquareDisplacement(every=2, max_lag=100), kept_by(case), 150)
    assert list(result.x["time"][:3]) == [0, 2, 4]
    assert np.nanmax(np.abs(result.deviation)) < 4.5
    found = result.comparisons[0]
    assert found.error < most * found.expected
    assert abs(found.measured - found.expected) < 4 * found.error


def test_wrong_diffusion_is_seen(make_case):
    case = make_case((6, 6, 6), timestep=1.0)
    result = watched(case, MeanSquareDisplacement(every=2, max_lag=100), kept_by(case) + 0.2, 150)
    assert result.comparisons[0].deviation > 5


def test_error_is_that_of_repeated_runs(make_case):
    case = make_case((4, 3, 3), timestep=1.0, thermostat=MaxwellBoltzmann())  # a walk has no start
    runs = [
        watched(case, MeanSquareDisplacement(every=2, max_lag=40), 0.2, 40, seed)
        for seed in range(20)
    ]
    spread = np.std([r.comparisons[0].measured for r in runs], ddof=1)
    quoted = np.sqrt(np.mean([r.comparisons[0].error ** 2 for r in runs]))
    assert 0.6 < quoted / spread < 1.5


def test_autocorrelation(make_case):
    case = make_case((8, 8), timestep=1.0, kT=2.0, mass=0.5)
    result = watched(case, VelocityAutocorrelation(max_lag=20), kept_by(case), 300)
    assert np.abs(result.deviation).max() < 4.5
    found = by_name(result)
    assert found["value at lag 0"].expected == 4.0
    names = ["value at lag 0", "share left after 1 tau", "diffusion coefficient up to 20 tau"]
    assert all(abs(found[name].deviation) < 4 for name in names)


def test_displacement_and_autocorrelation_expect_the_same_diffusion(make_case):
    """With what a particle stirs up: short flights, in 3D."""
    case = make_case((8, 8, 8), timestep=0.1, density=5)
    result = watched(case, VelocityAutocorrelation(max_lag=20), 0.5, 60)
    found = comparison(result, "diffusion")
    expected, note = Displacement(case, MeanSquareDisplacement()).coefficient()
    assert (found.expected, found.note) == (expected, note) and found.approximate
    assert expected > 1.1 * setting.transport(case).diffusion


def test_particles_that_know_nothing_of_hydrodynamics_have_no_tail(make_case):
    case = make_case((32, 32), density=5)
    observable = VelocityAutocorrelation(particles=10_000, max_lag=80)
    result = watched(case, observable, kept_by(case), 200)
    ratio = result.comparisons[-1]
    assert ratio.what == "ratio to the hydrodynamic tail"
    assert abs(ratio.measured) < 4 * ratio.error and ratio.error < 0.5


def test_lags_are_exact():
    """A deterministic sample: the value at each lag is that lag."""
    origins = Origins(4, 1, max_lag=100)
    for time in range(300):
        origins.add(np.full((4, 1), float(time)), lambda old, new: (new - old)[:, 0])
    assert origins.estimate().value == pytest.approx(origins.sampled())
    assert origins.sampled().max() == 96
    assert set(range(17)) < set(origins.sampled().tolist())
    assert np.diff(origins.sampled()).max() == 8


def test_memory_is_bounded_by_the_longest_lag():
    assert Origins(1000, 3, max_lag=1000).memory.nbytes < 3.1e6 < 1001 * 1000 * 3 * 8


def test_axes_with_flow_or_walls_are_left_out(make_case):
    observable = MeanSquareDisplacement()

    def axes(case):
        return Displacement(case, observable).axes

    walls, push = [Plates(axis="y")], Uniform((0.01, 0, 0))
    assert axes(make_case((8, 8, 8), walls=walls, force=push)) == (2,)
    assert axes(make_case((8, 8, 8), shear_rate=0.1)) == (1, 2)
    with pytest.raises(CaseError, match="every axis has a flow or a wall"):
        make_case((8, 8), [observable], walls=walls, force=Uniform((0.01, 0)))
    with pytest.raises(CaseError, match="under shear"):
        make_case((8, 8), [MeanSquareDisplacement(components=["x"])], shear_rate=0.1)
