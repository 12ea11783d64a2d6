"""Density along a flow that solids hold up."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import Array, DensityGradient, Disk, MaxwellBoltzmann, Plates, Rectangle, Uniform
from mesokit.errors import CaseError
from mesokit.method.mpcd.derived import derive
from mesokit.method.mpcd.expected.compression import compression
from tests.helpers.fake_fluid import FakeFluid
from tests.helpers.small_fluids import make_fluid

POSTS = Array(of=Disk(centre=(5.0, 5.0), radius=2.0), repeat=(3, 2))
PUSH = {"force": Uniform((0.02, 0.0)), "thermostat": MaxwellBoltzmann()}
BLOCK = Rectangle(centre=(2.0, 6.0), size=(4.0, 40.0))


def test_a_fluid_that_is_held_up_is_a_barometer():
    """Nothing flows through a block: exp(m g x/kT), as high as acceleration x length/(kT/m)."""
    observable = DensityGradient()
    fluid = make_fluid(
        (20, 12), observe=[observable], walls=(BLOCK,), density=10, timestep=0.3, **PUSH
    )
    accumulator = observable.accumulator(fluid.case)
    fluid.advance(400)
    for _ in range(400):
        fluid.advance(5)
        accumulator.observe(fluid)
    found = accumulator.result()
    x = found.x["x"]
    seen = np.isfinite(found.value)
    np.testing.assert_array_equal(seen, x > 4)
    line, covariance = np.polyfit(x[seen], np.log(found.value[seen]), 1, cov=True)
    assert abs(line[0] - 0.02) < 4 * covariance[0, 0] ** 0.5 + 0.0005
    ratio = found["largest density over smallest"]
    assert ratio.measured == pytest.approx(np.exp(0.02 * 15), abs=4 * ratio.error + 0.02)
    assert compression(fluid.case) == (0, pytest.approx(0.02 * 20))


def test_unit_cells_are_taken_together(make_case):
    observable = DensityGradient()
    case = make_case((30, 20), [observable], walls=(POSTS,), density=10, **PUSH)
    fluid = FakeFluid(case, field=np.zeros_like)
    accumulator = observable.accumulator(case)
    for _ in range(64):
        fluid.jump()
        accumulator.observe(fluid)
    found = accumulator.result()
    assert len(found.x["x"]) == 10 and found.extra["length"] == 10
    # particles are everywhere alike in what the posts leave free
    far = (found.value / found.value.mean() - 1) / (found.error / found.value.mean())
    assert np.abs(far).max() < 6 and abs(found.value.mean() / 10 - 1) < 0.02
    assert found["amplitude"].measured < 5 * found["amplitude"].error


def test_the_amplitude_is_that_of_the_density(make_case):
    observable = DensityGradient()
    case = make_case((30, 20), [observable], walls=(POSTS,), density=10, **PUSH)
    accumulator = observable.accumulator(case)
    volume = accumulator.volume()
    place = 2 * np.pi * (np.arange(10) + 0.5) / 10
    rng = np.random.default_rng(2)
    for _ in range(64):
        wave = 1 + 0.07 * np.cos(place - 1.0) + 0.001 * rng.normal(size=10)
        accumulator.blocks.add(10 * volume * wave)
    found = accumulator.result()
    assert found["amplitude"].measured == pytest.approx(7, abs=0.1)
    assert found["largest"].measured == pytest.approx(1.07 / 0.93, abs=0.02)


def test_check_warns_where_the_fluid_is_pressed_together(make_case):
    def warned(push):
        case = make_case((30, 20), walls=(POSTS,), force=Uniform((push, 0.0)))
        return [text for text in derive(case).warnings if "until the solids repeat" in text]

    assert not warned(0.02)  # 0.02 x 10: 0.2
    [said] = warned(0.05)
    assert "over 10 cells" in said and "factor of up to 1.5" in said


@pytest.mark.parametrize(
    ("observable", "words"),
    [
        (DensityGradient(axis="y"), "plates close it"),
        (DensityGradient(length=7.0), "length = 7: expected whole numbers of unit cells"),
        (DensityGradient(length=7.5), "bins_per_cell = 1: expected whole numbers"),
    ],
)
def test_what_cannot_be_is_refused(observable, words, make_case):
    with pytest.raises(CaseError, match=words):
        make_case((30, 20), [observable], walls=(Plates(axis="y"),))
