"""A flow that had not built up is no deviation from the theory of the steady one."""

import dataclasses
import json
import math
import subprocess
import sys

import numpy as np
import pytest

from mesokit import (
    Box,
    Case,
    FlowRate,
    Fluid,
    Plates,
    Run,
    Simulation,
    Study,
    Uniform,
    VelocityProfile,
)
from mesokit.io.tables import record
from mesokit.observe.shared.build_up import result_of
from mesokit.report.caption import compared
from mesokit.run.opened import RunFiles
from mesokit.seam.method import summary_of
from mesokit.seam.result import Result
from mesokit.study.merge import merge
from tests.helpers.fake_fluid import FakeFluid

NOTE = "not steady: the flow needs "


def flow(steps: int, warmup: int, seed: int = 1, height: int = 16) -> Case:
    """A driven slit, which builds up in some 200 steps to 1/e for a height of 16, 715 for 30."""
    return Case(
        run=Run(steps=steps, warmup=warmup, seed=seed),
        box=Box([60, height]),
        fluid=Fluid(force=Uniform([0.005, 0.0])),
        walls=[Plates("y")],
        observe=[VelocityProfile(axis="y", component="x", every=5)],
    )


@pytest.fixture(scope="module")
def early(tmp_path_factory):
    """Two runs that measure from the start, of two seeds."""
    folders = [tmp_path_factory.mktemp("early") / f"{seed}" for seed in (1, 2)]
    for seed, folder in enumerate(folders, start=1):
        Simulation(flow(500, 20, seed, 30), output=folder).run()
    return folders


def test_it_is_told_wherever_the_number_is(early, tmp_path):
    files = RunFiles(early[0])
    found = files.results["velocity-profile"].comparisons
    assert len(found) >= 2
    assert all(one.note.startswith(NOTE) and one.note.endswith("had 20") for one in found)
    assert all(math.isnan(one.deviation) and math.isnan(one.percent) for one in found)
    assert NOTE in str(found[0]) and "standard errors" not in str(found[0])
    assert record(found[0])["steady"] is False and record(found[0])["deviation"] is None
    caption = " ".join(compared(found, 6.0).split())
    assert NOTE.strip() in caption and "s.e." not in caption and "nan" not in caption
    for words in (["info", str(early[0])], ["info", str(early[0]), "--json"]):
        said = subprocess.run(
            [sys.executable, "-m", "mesokit", *words], capture_output=True, text=True, timeout=300
        ).stdout
        assert NOTE in " ".join(said.split())
    pooled = merge(early, tmp_path / "both").results["velocity-profile"].comparisons
    assert all(one.note.startswith(NOTE) for one in pooled)


def test_warnings_of_check_are_kept_with_runs_and_what_is_merged_of_them(early, tmp_path):
    merge(early, tmp_path / "both")
    said = list(summary_of(flow(500, 20, 1, 30)).warnings)
    assert [words for words in said if words.startswith("run.warmup = 20")]
    for folder in (*early, tmp_path / "both"):
        files = RunFiles(folder)
        assert files.provenance["warnings"] == said
        assert f"\n  warning: {said[0]}" in repr(files)


def test_a_study_tells_it_of_pooled_numbers(tmp_path):
    study = Study(flow(500, 20, height=30), None, 2, output=tmp_path / "study")
    study.run(threads=1)
    rows = [row for row in study.table() if row.observable == "velocity-profile"]
    assert len(rows) >= 2
    assert all(row.number.note.startswith(NOTE) for row in rows)
    assert all(math.isnan(row.number.deviation) for row in rows)


@pytest.mark.parametrize(("steps", "warmup", "height"), [(2000, 2000, 16), (1500, 700, 8)])
def test_a_flow_that_has_built_up_is_compared(steps, warmup, height):
    simulation = Simulation(flow(steps, warmup, height=height))
    simulation.run()
    found = simulation["velocity-profile"].comparisons
    assert not [one for one in found if not one.steady]
    assert math.isfinite(found[0].deviation) and abs(found[0].deviation) < 4


def test_what_is_lacking_is_the_mean_of_an_exponential():
    from mesokit.seam.method import BuildUp

    steps = [math.exp(-(50 + n) / 200.0) for n in range(1000)]
    assert BuildUp(200.0, 600, 50).lacks(1000) == pytest.approx(sum(steps) / 1000, rel=0.01)


def with_a_speed_that(grows: float) -> Result:
    """The rate of a flow whose speed grows by so much over the samples, beside noise."""
    case = dataclasses.replace(flow(4000, 2000), observe=[FlowRate(every=10)])
    accumulator, fluid = case.observe[0].accumulator(case), FakeFluid(case)
    noise = np.random.default_rng(7).normal(0, 0.02, 400)
    for n in range(400):
        fluid.step = 2000 + 10 * (n + 1)
        speed = 0.1 + grows * n / 400 + noise[n]
        fluid.totals = lambda v=speed: (fluid.n, fluid.m.sum() * np.array([v, 0.0]), 0.0)
        accumulator.observe(fluid)
    return result_of(accumulator, case)


def test_a_flow_that_still_changes_is_not_compared():
    """By the samples themselves, whatever the warm-up."""
    (first, *_), steady = (with_a_speed_that(grows).comparisons for grows in (0.1, 0.0))
    assert first.note.startswith("not steady: mean velocity along x 0.12")
    assert "in the first half, 0.17" in first.note and math.isnan(first.deviation)
    assert all(one.steady for one in steady) and math.isfinite(steady[0].deviation)


def test_json_of_info_is_json(early):
    said = subprocess.run(
        [sys.executable, "-m", "mesokit", "info", str(early[0]), "--json"],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert json.loads(said.stdout)
