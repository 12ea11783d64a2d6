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
    Disk,
    FlowRate,
    Fluid,
    Forces,
    MaxwellBoltzmann,
    Plates,
    Run,
    Simulation,
    Study,
    Surface,
    Uniform,
    VelocityField,
    VelocityProfile,
    WallStress,
)
from mesokit.io.tables import record
from mesokit.method.mpcd.observe.shared.flow_memory import build_up_of, flow_memory
from mesokit.observe.shared.build_up import result_of
from mesokit.observe.shared.caveats import with_those_of
from mesokit.report.caption import compared
from mesokit.run.opened import RunFiles
from mesokit.seam.method import summary_of
from mesokit.seam.observable import Accumulator
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks
from mesokit.study.axes import Axis
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


def test_a_flow_that_still_changes_is_not_compared():
    """By the samples themselves, whatever the warm-up."""
    (first, *_), steady = (
        result_of(one, one.case).comparisons
        for one in (rate_with_a_speed_that(grows, 7) for grows in (0.1, 0.0))
    )
    assert first.note.startswith("not steady: mean velocity along x 0.12")
    assert "in the first half, 0.17" in first.note and math.isnan(first.deviation)
    assert all(one.steady for one in steady) and math.isfinite(steady[0].deviation)


@pytest.mark.parametrize(("height", "told_apart"), [(30, False), (16, True)])
def test_halves_of_less_than_a_relaxation_time_are_not_told_apart(height, told_apart):
    """500 steps after 3000, where the flow builds up in 715 or 200: fluctuations last as long."""
    case = dataclasses.replace(flow(500, 3000, height=height), observe=[FlowRate(every=5)])
    accumulator, fluid = case.observe[0].accumulator(case), FakeFluid(case)
    noise = np.random.default_rng(5).normal(0, 0.004, 100)
    for n in range(100):
        fluid.step = 3000 + 5 * (n + 1)
        speed = 0.1 + 0.3 * n / 100 + noise[n]
        fluid.totals = lambda v=speed: (fluid.n, fluid.m.sum() * np.array([v, 0.0]), 0.0)
        accumulator.observe(fluid)
    (rate, *_) = result_of(accumulator, case).comparisons
    assert ("first half" in rate.note) == told_apart != rate.steady
    assert rate.lower_bound != told_apart


def test_a_mach_number_before_the_flow_has_built_up_is_marked():
    case = dataclasses.replace(flow(100, 5, height=30), observe=[VelocityField(every=20)])
    simulation = Simulation(case)
    simulation.run()
    (mach,) = simulation["velocity-field"].comparisons
    assert mach.what == "largest Mach number" and mach.note.startswith("not steady: the flow needs")


def test_json_of_info_is_json(early):
    said = subprocess.run(
        [sys.executable, "-m", "mesokit", "info", str(early[0]), "--json"],
        capture_output=True, text=True, timeout=300,
    )  # fmt: skip
    assert json.loads(said.stdout)


def rate_with_a_speed_that(grows: float, seed: int) -> Accumulator:
    """The memory of a flow rate whose speed grows by so much over the samples, beside noise."""
    case = dataclasses.replace(flow(4000, 2000), observe=[FlowRate(every=10)])
    accumulator, fluid = case.observe[0].accumulator(case), FakeFluid(case)
    noise = np.random.default_rng(seed).normal(0, 0.02, 400)
    for n in range(400):
        fluid.step = 2000 + 10 * (n + 1)
        speed = 0.1 + grows * n / 400 + noise[n]
        fluid.totals = lambda v=speed: (fluid.n, fluid.m.sum() * np.array([v, 0.0]), 0.0)
        accumulator.observe(fluid)
    return accumulator


@pytest.mark.parametrize(("grows", "said"), [(0.08, True), (0.0, False)])
def test_pooled_runs_that_still_change_are_not_compared(grows, said):
    one, *others = (rate_with_a_speed_that(grows, seed) for seed in (3, 4, 5))
    for other in others:
        one.pool(other)
    found = result_of(one, one.case).comparisons
    assert [c.note.startswith("not steady: mean velocity") for c in found] == [said] * len(found)


def test_a_study_takes_over_what_its_runs_say_of_themselves(tmp_path):
    """An obstacle in the way, whose flow tells by its momentum how long it takes to build up."""
    case = dataclasses.replace(
        flow(800, 0),
        box=Box([32, 32]),
        fluid=Fluid(force=Uniform([0.02, 0.0])),
        walls=[Disk([16, 16], 4)],
        observe=[FlowRate(every=5)],
    )
    study = Study(case, [Axis.parse("fluid.density=9,11")], 2, output=tmp_path / "study")
    study.run(threads=1)
    rows = study.table()
    assert all(one.note.startswith("not steady") for row in rows for one in row.each)
    assert all(row.number.note.startswith("not steady") for row in rows)
    number = "flow-rate.mean-velocity-along-x"
    figure = study.plot("fluid.density", number)
    assert figure._supxlabel.get_text() == "not steady at all points"
    page = study.report().read_text()
    assert page.count("not steady: the flow needs") >= len(rows)
    assert study.to_csv().read_text().count("not steady") == len(rows)
    merged = study.merged(1).record()
    assert not any(one["steady"] for one in merged["comparisons"])


def numbers_with(*notes: str) -> list[Result]:
    """One number of several runs, or of all of them."""
    return [
        Result("flow-rate", "flow-rate", {}, 0.1, 0.01, "v", {}, comparisons=(one,))
        for one in (Comparison("rate", 0.1, 0.01, 0.101, "a/tau", note) for note in notes)
    ]


@pytest.mark.parametrize(
    ("pooled", "runs", "note"),
    [
        ("", ["", "not steady: 2 in the first half, 3 in the second; a law"], "not steady: 2 in"),
        ("a law", ["approximate: ideal gas; p = 0.3", ""], "approximate: ideal gas; a law"),
        ("a law", ["error bar is a lower bound: short"] * 2 + [""], "a law; error bar is a lower"),
        ("a law", ["error bar is a lower bound: short", "", ""], "a law"),
        ("not steady: all", ["not steady: 1", "error bar is a lower bound: 2"], "not steady: all"),
    ],
)  # fmt: skip
def test_pooled_numbers_have_the_caveats_of_runs(pooled, runs, note):
    (found,) = with_those_of(*numbers_with(pooled), numbers_with(*runs)).comparisons
    assert found.note.startswith(note) and ("law" in found.note) == ("law" in pooled)


@pytest.mark.parametrize(("steps", "height"), [(60, 16), (100, 24)])
def test_a_short_run_of_a_flow_that_has_built_up_has_its_own_caveat(steps, height):
    simulation = Simulation(flow(steps, 8 * height**2, height=height))
    simulation.run()
    [viscosity, *_] = simulation["velocity-profile"].comparisons
    assert "error bar is a lower bound: the run has 0." in viscosity.note
    assert "needs" not in viscosity.note


@pytest.mark.parametrize(("side", "radius", "g"), [(24, 3, 0.02), (32, 6, 0.03)])
def test_the_momentum_tells_how_long_a_flow_past_an_obstacle_takes(side, radius, g):
    """In a periodic array no theory knows; half a run that builds up gives the time of a whole."""
    found = {}
    for warmup, steps in ((0, 150), (1500, 1500)):
        case = Case(
            run=Run(steps=steps, warmup=warmup, seed=3),
            box=Box([side, side]),
            fluid=Fluid(force=Uniform([g, 0.0])),
            walls=[Disk([side / 2, side / 2], radius)],
            observe=[FlowRate(), Forces(length=2 * radius, every=5)],
        )
        simulation = Simulation(case)
        simulation.run()
        notes = [c.note for name in ("flow-rate", "forces") for c in simulation[name].comparisons]
        found[warmup] = [note.startswith("not steady: the flow needs") for note in notes]
    assert len(found[0]) >= 6
    assert found == {0: [True] * len(found[0]), 1500: [False] * len(found[0])}


@pytest.mark.parametrize("time", [5.0, 40.0, 300.0])
@pytest.mark.parametrize(("had", "length"), [(0.0, 60.0), (30.0, 200.0)])
def test_the_time_of_a_flow_from_rest_is_that_of_its_exponential(time, had, length):
    """A slit in free fall gains g t; what holds it leaves g time (1 - exp(-t/time))."""
    case = Case(
        run=Run(steps=round(length / 0.1), warmup=round(had / 0.1)),
        box=Box([32, 32]),
        fluid=Fluid(force=Uniform([0.02, 0.0])),
        walls=[Disk([16, 16], 4)],
        observe=[FlowRate()],
    )
    mass = 10 * (32 * 32 - math.pi * 16)
    t = had + length * (np.arange(10_000) + 0.5) / 10_000
    momentum = mass * 0.02 * float((time * (1 - np.exp(-t / time))).mean())
    blocks = Blocks()
    for _ in range(round(length)):
        blocks.add(0.0)
    found = flow_memory(case, 0, momentum, blocks, every=10)
    assert found.time == pytest.approx(time, rel=5e-3)
    assert found.relaxations == pytest.approx(length / time, rel=5e-3)
    low = flow_memory(case, 0, momentum - found.least, blocks, every=10)  # by chance
    assert low.time < time < build_up_of(low, case).steps * 0.1


def test_a_flow_that_builds_up_leaves_the_pressure_on_plates():
    """The pressure is that of the fluid at rest from the start; the drag is not."""
    case = Case(
        run=Run(steps=160, warmup=10, seed=4),
        box=Box([40, 20]),
        fluid=Fluid(density=7, thermostat=MaxwellBoltzmann()),
        walls=[Plates("y", upper=Surface(velocity=(0.3, 0)))],
        observe=[WallStress(every=1)],
    )
    simulation = Simulation(case, threads=1)
    simulation.run()
    found = simulation["wall-stress"].comparisons
    drags, pressures = (
        [one for one in found if one.what.startswith(what)] for what in ("drag", "pressure")
    )
    assert len(drags) == len(pressures) == 2
    assert all(one.note.startswith(NOTE) for one in drags)
    assert all(one.steady and abs(one.deviation) < 4 for one in pressures)


def test_a_pressure_that_changes_is_not_steady():
    """By its own samples, whatever the flow does."""
    case = Case(
        run=Run(steps=640),
        box=Box([10, 10]),
        fluid=Fluid(),
        walls=[Plates("y")],
        observe=[WallStress(every=1)],
    )
    accumulator, noise = case.observe[0].accumulator(case), np.random.default_rng(2)
    for n in range(640):
        pressure = 10 + 0.002 * n + 0.1 * noise.normal()
        accumulator.blocks.add(np.array([[0.0, -pressure], [0.0, pressure]]))
    found = result_of(accumulator, case).comparisons
    assert found and all(one.note.startswith("not steady: pressure on") for one in found)


def test_pooled_samples_decide_whether_a_flow_past_an_obstacle_has_built_up(tmp_path):
    """The momentum of one run may be off by chance; the words are those of one estimate."""
    case = Case(
        run=Run(steps=400, warmup=160),
        box=Box([20, 20]),
        fluid=Fluid(force=Uniform([0.02, 0.0]), thermostat=MaxwellBoltzmann()),
        walls=[Disk([10, 10], 4)],
        observe=[FlowRate(every=5), Forces(length=8, every=5)],
    )
    study = Study(case, None, 3, output=tmp_path / "study")
    study.run(threads=1)
    rows = study.table()
    for name in ("flow-rate", "forces"):
        notes = [row.number.note for row in rows if row.observable == name]
        said = {note.split("; ")[0] for note in notes}
        assert len(notes) >= 3 and len(said) == 1
        assert "steady flow" not in " ".join(notes)
        assert said.pop().startswith("not steady: the flow needs up to ")
    words = {row.number.note.split(" steps")[0] for row in rows}
    assert len(words) == 1  # two digits, and one momentum


@pytest.mark.parametrize(
    ("pooled", "runs", "note"),
    [
        ("a law", ["not steady: the flow needs up to 1200 steps; a law", ""], "a law"),
        ("a law", ["not steady: the flow still lacked 7 % of its speed"] * 3, "a law"),
        (
            "not steady: the flow needs up to 800 steps",
            ["approximate: thin; a law", "not steady: the flow needs up to 830 steps"],
            "not steady: the flow needs up to 800 steps; approximate: thin",
        ),
    ],
)
def test_the_flow_of_all_runs_decides_for_the_pooled_number(pooled, runs, note):
    (found,) = with_those_of(*numbers_with(pooled), numbers_with(*runs)).comparisons
    assert found.note == note


@pytest.mark.parametrize("runs", [1, 3])
def test_relaxation_times_are_those_of_each_run(runs):
    """Here a speed of 0.1 along plates 30 apart, for 1200 steps."""
    case = dataclasses.replace(flow(1200, 6000), observe=[FlowRate(every=10)])
    pooled, fluid = case.observe[0].accumulator(case), FakeFluid(case)
    for run in range(runs):
        accumulator = pooled if run == 0 else case.observe[0].accumulator(case)
        noise = np.random.default_rng(run).normal(0.1, 0.02, 120)
        for n, speed in enumerate(noise + 0.1 - noise.mean()):
            fluid.step = 6000 + 10 * (n + 1)
            fluid.totals = lambda v=speed: (fluid.n, fluid.m.sum() * np.array([v, 0.0]), 0.0)
            accumulator.observe(fluid)
        if run:
            pooled.pool(accumulator)
    note = result_of(pooled, case).comparisons[0].note
    each = "the" if runs == 1 else "each"
    assert f"{each} run has 6 relaxation times" in note  # 120 tau over 0.1/0.005
