"""Frames of the flow: what they average over, what they keep, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from mesokit import DensityField, FlowFrames, VelocityField
from mesokit.errors import CaseError
from mesokit.io import h5md
from mesokit.method.mpcd.fluid import Species
from mesokit.observe.flow_frames import average
from tests.helpers.fake_fluid import FakeFluid


def watched(case, observables, samples, every=10, **options):
    accumulators = [observable.accumulator(case) for observable in observables]
    fluid = FakeFluid(case, **options)
    for _ in range(samples):
        fluid.advance(every)
        for accumulator in accumulators:
            accumulator.observe(fluid)
    return [accumulator.result() for accumulator in accumulators]


@pytest.mark.parametrize("samples", [20, 23])  # whole windows, and one cut short
@pytest.mark.parametrize(
    "fluid", [{"density": 5}, {"species": (Species(1.0, 3.0), Species(4.0, 2.0))}]
)
def test_the_mean_of_the_frames_is_the_map_of_the_whole_run(make_case, fluid, samples):
    case = make_case((8, 6), **fluid)
    frames, velocity, density = watched(
        case, [FlowFrames(window=50), VelocityField(), DensityField()], samples,
        flow=lambda y: 0.3 * y,
    )  # fmt: skip
    mean = average(frames)
    np.testing.assert_allclose(mean.value, velocity.value, rtol=1e-5, atol=1e-6)
    assert list(mean.x) == list(velocity.x) and mean.units == velocity.units
    weight = frames.extra["samples"]
    found = np.average(frames.value[..., 0], axis=0, weights=weight)
    np.testing.assert_allclose(found, density.value, rtol=1e-6)
    assert weight.tolist() == [5] * (samples // 5) + [samples % 5] * (samples % 5 > 0)
    assert frames.samples == samples


def test_error_bars_of_the_mean_are_those_of_its_scatter(make_case):
    case = make_case((4, 4), density=20)
    frames, velocity = watched(case, [FlowFrames(window=10), VelocityField()], 400)
    ratio = np.nanmedian(average(frames).error) / np.nanmedian(velocity.error)
    assert 0.7 < ratio < 1.4


def test_a_frame_knows_its_time_and_where_particles_were(make_case):
    case = make_case((6, 6), density=4)
    accumulator, fluid = FlowFrames(window=20, particles=7).accumulator(case), FakeFluid(case)
    seen = []
    for _ in range(6):
        fluid.advance(10)
        accumulator.observe(fluid)
        seen.append((fluid.time, fluid.positions(accumulator.ids)))
    frames = accumulator.result()
    np.testing.assert_allclose(
        frames.x["time"], [(seen[k][0] + seen[k + 1][0]) / 2 for k in (0, 2, 4)]
    )
    assert frames.extra["positions"].shape == (3, 7, 2)
    np.testing.assert_allclose(
        frames.extra["positions"], [seen[k][1] for k in (0, 2, 4)], rtol=1e-6
    )


def test_bins_without_particles_have_no_velocity(make_case):
    case = make_case((4, 4), density=0.5)
    (frames,) = watched(case, [FlowFrames(window=10, particles=0)], 3)
    empty = frames.value[..., 0] == 0
    assert empty.any()
    assert np.isnan(frames.value[empty][:, 1:]).all()
    assert np.isfinite(frames.value[~empty]).all()


def test_frames_come_back_from_a_file(make_case, tmp_path):
    case = make_case((16, 16), observe=[FlowFrames(window=10, bins_per_cell=4)])
    (frames,) = watched(case, case.observe, 90)
    assert frames.value.size > h5md.LARGE
    h5md.write(tmp_path / "run.h5", case, {}, [frames])
    assert h5md.read_results(tmp_path / "run.h5")["flow-frames"] == frames


@pytest.mark.parametrize(
    ("observable", "words"),
    [
        (
            FlowFrames(window=25),
            "observe[#1].window = 25: expected a multiple of every = 10, such as 30",
        ),
        (FlowFrames(axes=("x", "z")), "observe[#1].axes"),
        (FlowFrames(axes=("x", "x")), "expected two different axes"),
    ],
)
def test_it_refuses(make_case, observable, words):
    with pytest.raises(CaseError) as error:
        make_case((8, 8), observe=[observable])
    assert words in str(error.value)


def test_it_refuses_more_than_memory_holds():
    from mesokit import Box, Case, Run

    with pytest.raises(CaseError, match=r"window = 10: 100000 frames are .* GB\); expected"):
        Case(run=Run(steps=1_000_000), box=Box((60, 30)), observe=[FlowFrames(window=10)])
