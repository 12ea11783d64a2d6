"""Runs of one case as one."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import mesokit
from mesokit import Box, Case, Run, Simulation, TemperatureProfile
from mesokit.errors import RunError
from mesokit.statistics import Blocks, MultipleTau, TimeSeries
from mesokit.study.merge import merge

SEEDS = (5, 6, 7)


def with_seed(case: Case, seed: int, steps: int = 120) -> Case:
    return dataclasses.replace(case, run=Run(steps=steps, warmup=10, seed=seed))


@pytest.fixture(scope="module")
def case(case_file) -> Case:
    """With one observable for each way in which samples are kept."""
    text = case_file.read_text() + "".join(
        f'[[observe]]\nquantity = "{name}"\n{more}\n'
        for name, more in (
            ("conservation", "every = 20"),
            ("wall-stress", "every = 6"),
            ("mean-square-displacement", 'components = ["x"]\nmax_lag = 40\nevery = 5'),
            ("transverse-modes", "every = 4"),
            ("flow-frames", "window = 30\nparticles = 10"),
            ("probe", "every = 1\nsize = [4, 4]"),
        )
    )
    path = case_file.with_name("merge.toml")
    path.write_text(text)
    return Case.from_toml(path)


@pytest.fixture(scope="module")
def runs(case, tmp_path_factory):
    """Runs with three seeds, the last one longer, in folders of their own."""
    folder = tmp_path_factory.mktemp("merge")
    made = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("mesokit.report.save_all", lambda *given, **more: [])
        for seed in SEEDS:
            steps = 180 if seed == SEEDS[-1] else 120
            simulation = Simulation(with_seed(case, seed, steps), output=folder / f"{seed}")
            simulation.run()
            made.append(simulation)
    return made


@pytest.fixture(scope="module")
def merged(runs, tmp_path_factory):
    output = tmp_path_factory.mktemp("merged") / "all"
    return merge([simulation.directory.path for simulation in runs], output)


def test_samples_are_pooled(runs, merged):
    """A ratio is that of all samples, not the mean of ratios; the folder opens as a run does."""
    blocks = [simulation.accumulators["velocity-profile"].blocks.sums()[0] for simulation in runs]
    momentum, mass = np.concatenate(blocks).sum(axis=0)
    profile = merged["velocity-profile"]
    np.testing.assert_allclose(profile.value, momentum / mass, rtol=1e-13)
    assert profile.samples == sum(s["velocity-profile"].samples for s in runs) == 143
    own = np.array([s["velocity-profile"].error for s in runs])
    assert 0.35 < np.median(profile.error / own.mean(axis=0)) < 0.8  # 1 / sqrt(3), roughly
    assert merged.ended and (merged.path / "velocity-profile.png").exists()
    assert [e["seed"] for e in merged.provenance["merged"]] == list(SEEDS)
    assert [e["step"] for e in merged.provenance["merged"]] == [130, 130, 190]


def test_every_kind_of_memory(runs, merged):
    one = [simulation.results for simulation in runs]
    assert set(merged.results) == set(one[0])
    for name, result in merged.results.items():
        found = [results[name] for results in one]
        if name != "flow-frames":
            assert result.samples == sum(r.samples for r in found), name
    rows = [r["conservation"].value[:7] for r in one]
    np.testing.assert_allclose(merged["conservation"].value, np.mean(rows, axis=0))
    frames = [r["flow-frames"].value[:4, ..., 0] for r in one]
    np.testing.assert_allclose(
        merged["flow-frames"].value[..., 0], np.mean(frames, axis=0), rtol=1e-5
    )
    at = slice(1, 5)
    moved = np.array([r["mean-square-displacement"].value[at] for r in one])
    pooled = merged["mean-square-displacement"].value[at]
    assert (pooled > moved.min(axis=0)).all() and (pooled < moved.max(axis=0)).all()
    power = [r["probe"] for r in one[:2]]
    assert merged["probe"].x["frequency"].shape == power[0].x["frequency"].shape


def test_a_longer_run_counts_for_more():
    """Pooled blocks of two series are those of the one that they are cut from."""
    samples = np.random.default_rng(3).normal(size=(96, 2))
    whole, first, second = Blocks((2,)), Blocks((2,)), Blocks((2,))
    for i, sample in enumerate(samples):
        whole.add(sample)
        (first if i < 32 else second).add(sample)
    first.pool(second)
    np.testing.assert_allclose(first.mean(), whole.mean(), rtol=1e-14)
    assert first.count == 96 and first.sums()[1].sum() == 96
    with pytest.raises(ValueError, match="cannot pool"):
        first.pool(Blocks((3,)))


def test_correlations_of_runs_of_different_length():
    """Lags that only the longer one has reached are its own."""
    random = np.random.default_rng(5)
    short, long = MultipleTau(), MultipleTau()
    a, b = random.normal(size=20), random.normal(size=400)
    for correlator, series in ((short, a), (long, b)):
        for sample in series:
            correlator.add(sample)
    alone = long.correlation()
    short.pool(long)
    found = short.correlation()
    assert short.count == 420
    np.testing.assert_array_equal(found.lag, alone.lag)
    expected = (a[:-3] @ a[3:] + b[:-3] @ b[3:]) / (17 + 397)
    assert found.value[3] == pytest.approx(expected)
    np.testing.assert_allclose(found.value[-5:], alone.value[-5:])


def test_series_of_different_stride():
    one, other = TimeSeries(1, rows=8), TimeSeries(1, rows=8)
    for time in range(8):
        one.add(time, [time])
    for time in range(24):
        other.add(time, [3 * time])
    one.pool(other)
    assert one.stride == other.stride == 4
    np.testing.assert_allclose(one.time(), [1.5, 5.5])
    np.testing.assert_allclose(one.values()[:, 0], [3.0, 11.0])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"fluid.density": "5"}, r"another case than .*: fluid\.density = 5, not 9\.52"),
        ({"run.seed": "5"}, r"run\.seed = 5, as in .*: the same run would count twice"),
        ({"run.warmup": "20"}, r"run\.warmup = 20, not 10"),
        ({"observe.flow-rate.every": "5"}, r"observe\.\d+\.every = 5, not 10"),
    ],
)
def test_different_runs_are_refused(runs, case_file, tmp_path, change, words):
    path = case_file.with_name("merge.toml")
    other = Case.from_toml(path, {"run.seed": "9", "run.steps": "20"} | change)
    simulation = Simulation(other, output=tmp_path / "other")
    simulation.checkpoint()
    with pytest.raises(RunError, match=words):
        merge([runs[0].directory.path, tmp_path / "other"], tmp_path / "all")
    assert not (tmp_path / "all").exists()


def test_what_is_merged_neither_goes_on_nor_is_merged_again(runs, merged, tmp_path):
    with pytest.raises(RunError, match="holds merged runs; go on with those"):
        Simulation.resume(merged.path)
    with pytest.raises(RunError, match="holds merged runs; name those"):
        merge([runs[0].directory.path, merged.path], tmp_path / "all")
    with pytest.raises(RunError, match="1 run: expected two or more"):
        merge([runs[0].directory.path], tmp_path / "all")


def test_an_accumulator_that_cannot(runs, tmp_path, monkeypatch):
    from mesokit.method.mpcd.observe.flow_rate import FlowRateAccumulator

    monkeypatch.setattr(FlowRateAccumulator, "pool", property(), raising=False)  # it has none
    with pytest.raises(RunError, match="observable 'flow-rate': its runs cannot be pooled"):
        merge([s.directory.path for s in runs[:2]], tmp_path / "all")


def test_a_run_that_goes_on_counts_so_far(runs, case, tmp_path):
    simulation = Simulation(with_seed(case, 11), output=tmp_path / "early")
    simulation.run(70)
    files = merge([runs[0].directory.path, tmp_path / "early"], tmp_path / "all")
    assert files["velocity-profile"].samples == 41 + 21
    assert mesokit.open(tmp_path / "all").provenance["merged"][1]["step"] == 70


def test_pooled_error_bars_are_honest():
    """The error bar of 40 correlated series together is that by which their means scatter."""
    random, keep = np.random.default_rng(8), 0.9
    pooled, means = None, []
    for _ in range(40):
        series = Blocks()
        x = random.normal() / np.sqrt(1 - keep**2)
        for _ in range(200):
            x = keep * x + random.normal()
            series.add(x)
        means.append(series.mean())
        if pooled is None:
            pooled = Blocks.from_state(series.state())
        else:
            pooled.pool(series)
    scatter = np.std(means, ddof=1) / np.sqrt(40)
    assert pooled.error() / scatter == pytest.approx(1, abs=0.2)  # 11 % is that of the scatter


def test_runs_together_know_the_temperature_better_than_their_starts():
    """Each keeps the energy that it began with; the mean of many scatters less by their root."""
    observe = [TemperatureProfile(axis="y", every=5)]
    pooled, means = None, []
    for seed in range(12):
        run = Run(steps=60, seed=seed)
        simulation = Simulation(run=run, box=Box([8, 8]), observe=observe, threads=1)
        simulation.run()
        (number,) = simulation["temperature-profile"].comparisons[:1]
        means.append(number.measured)
        accumulator = simulation.accumulators["temperature-profile"]
        pooled = pooled or accumulator
        if pooled is not accumulator:
            pooled.pool(accumulator)
    (together,) = pooled.result().comparisons[:1]
    assert together.what == number.what == "mean temperature"
    assert number.error / together.error == pytest.approx(12**0.5, rel=0.15)
    scatter = np.std(means, ddof=1) / 12**0.5
    assert abs(np.log(together.error / scatter)) < 3 / np.sqrt(2 * 11)


def test_a_merge_is_there_whole_or_not_at_all(runs, tmp_path, monkeypatch):
    folders = [simulation.directory.path for simulation in runs]
    with monkeypatch.context() as broken:
        broken.setattr("mesokit.report.save_all", lambda *given, **more: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            merge(folders, tmp_path / "all")
    assert not list(tmp_path.iterdir())
    killed = tmp_path / ".all.part"  # what a killed one leaves
    killed.mkdir()
    (killed / "case.toml").write_text("half")
    (tmp_path / "all").mkdir()
    assert merge(folders, tmp_path / "all").ended
    assert [path.name for path in tmp_path.iterdir()] == ["all"]
    with pytest.raises(RunError, match="not empty"):
        merge(folders, tmp_path / "all")
