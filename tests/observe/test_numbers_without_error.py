"""Every number has an error bar, is a count, or says that it has none."""

import math

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    Conservation,
    DensityField,
    Fluid,
    GranularTemperature,
    HardCollision,
    Plates,
    Run,
    Stress,
    Uniform,
)
from mesokit.observe.shared.build_up import result_of
from mesokit.observe.shared.short_run import without_error
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries
from tests.helpers.hard_spheres import gas

ONE = "no error bar: one run; --seeds 4 or more give one"


def memory(values):
    """The memory of one run whose temperatures fall from 1 to such values."""
    case = Case(
        run=Run(4, method="event-driven"),
        box=Box([40, 40]),
        spheres=gas([40, 40], number=300, collision=HardCollision(restitution=0.7)).case.spheres,
        observe=[GranularTemperature(every=1)],
    )
    accumulator = case.observe[0].accumulator(case)
    for time, kT in enumerate(values):
        accumulator.series.add(float(time), [kT, 0.3 * kT, 2.0 * time])
        accumulator.samples += 1
    return case, accumulator


def test_the_temperature_of_one_gas_that_cools_has_the_error_of_its_velocities():
    case, accumulator = memory([1.0, 0.6, 0.35, 0.21, 0.2])
    found = result_of(accumulator, case).comparisons
    assert [one.what.split()[1] for one in found] == ["at", "at", "after"]
    for one in found:
        assert one.error == pytest.approx(one.measured * math.sqrt(2 / (2 * 299)))
        assert "no error bar" not in one.note and "(" in str(one).split(",")[0]
        assert one.lower_bound  # velocities are not independent once the gas has clusters


def test_the_temperature_of_several_gases_has_the_error_of_their_scatter():
    rng, runs = np.random.default_rng(5), 6
    ends = 0.2 + 0.02 * rng.normal(size=runs)
    case, pooled = memory([1.0, 0.6, 0.35, 0.24, ends[0]])
    for end in ends[1:]:
        pooled.pool(memory([1.0, 0.6, 0.35, 0.24, end])[1])
    result = result_of(pooled, case)
    assert result.comparisons[0].measured == pytest.approx(ends.mean())
    assert result.comparisons[0].error == pytest.approx(ends.std(ddof=1) / math.sqrt(runs))
    assert result.error[-1, 0] == pytest.approx(result.comparisons[0].error)
    assert not result.comparisons[0].lower_bound


@pytest.mark.parametrize(
    ("samples", "words"), [(1, "no error bar: of 1 sample"), (3, "no error bar: of 3 samples")]
)
def test_a_stress_of_few_samples_says_that_it_has_no_error_bar(samples, words):
    case = Case(
        run=Run(steps=9), box=Box([6, 6], shear_rate=0.01), fluid=Fluid(), observe=[Stress(every=1)]
    )
    accumulator = case.observe[0].accumulator(case)
    for n in range(samples):
        stress = np.array([[-10.07, 0.0613 + 0.01 * n], [0.07, -10.3]])
        accumulator.blocks.add(np.stack([stress, 1.13 * stress, 2.13 * stress]))
    found = result_of(accumulator, case).comparisons
    bare = [one for one in found if math.isnan(one.error)]
    assert bare and all(words in one.note and words in str(one) for one in bare)


@pytest.mark.parametrize("percent", [0.0, 3.0, 12.0])
def test_the_spread_of_a_density_has_the_error_of_its_seeds(percent):
    """Of a flat map it is no less than the scatter of seeds, and below the noise of a bin."""
    case = Case(
        run=Run(steps=9),
        box=Box([12, 12]),
        fluid=Fluid(force=Uniform([0.01, 0.0])),
        walls=[Plates("y")],
        observe=[DensityField(every=1)],
    )
    wave = 1 + 0.01 * percent * np.sqrt(2) * np.sin(2 * np.pi * (np.arange(12) + 0.5) / 12)
    found = []
    for seed in range(40):
        rng, accumulator = np.random.default_rng(seed), case.observe[0].accumulator(case)
        for _ in range(500):
            accumulator.blocks.add(rng.poisson(7 * np.tile(wave, (12, 1)))[None] * 1.0)
        (one,) = accumulator.result().comparisons
        found.append((one.measured, one.error))
    spread, error = np.transpose(found)
    if percent:
        assert spread.mean() == pytest.approx(percent, rel=0.1)
        assert spread.std() / error.mean() == pytest.approx(1, abs=0.35)
    else:
        noise = 100 / np.sqrt(7 * 500)  # of one bin
        assert np.sqrt((spread**2).mean()) < error.mean() < 0.6 * noise


def test_counts_and_what_must_be_exact_need_no_words():
    counts = tuple(
        Comparison(what, value, error)
        for what, value, error in (("events", 7.0, math.nan), ("drift", 0.125, 0.0))
    )
    result = Result("q", "q", {}, 1.0, 0.1, "q", {}, comparisons=counts)
    assert without_error(result, None).comparisons == counts
    case = Case(run=Run(steps=9), box=Box([6, 6]), fluid=Fluid(), observe=[Conservation()])
    assert not result_of(case.observe[0].accumulator(case), case).comparisons


@pytest.mark.parametrize(
    ("runs", "words"), [(1, ONE), (3, ONE.replace("one run", "3 runs")), (4, "no error bar")]
)
def test_a_value_of_one_instant_says_how_to_have_an_error_bar(runs, words):
    class Height:
        series = TimeSeries(1)

    Height.series.add(0.0, [2.5])
    for _ in range(runs - 1):
        Height.series.pool(TimeSeries(1))
    bare = Comparison("height", 2.5, math.nan, note="at rest")
    result = Result("h", "h", {}, 1.0, 0.1, "h", {}, comparisons=(bare,))
    (found,) = without_error(result, Height()).comparisons
    assert found.note == f"at rest; {words}"
    blocks = Blocks()
    for value in range(20):
        blocks.add(float(value))
    Height.blocks = blocks
    assert without_error(result, Height()).comparisons[0].note == "at rest; no error bar"
