"""Studies: runs that are those of their cases, a table, pictures, stops."""

from __future__ import annotations

import csv
import json
import shutil
from pathlib import Path

import numpy as np
import pytest

import mesokit
from mesokit import Study
from mesokit.errors import CaseError, RunError
from mesokit.study import local
from mesokit.study.drive import StudyReporter
from tests.helpers.studies import FORCE, said


def test_runs_are_those_of_their_cases(study, case_file):
    """Each to the bit, in a folder as any run has it."""
    assert study.ended and len(study) == 6
    for run in (study.runs[0], study.runs[-1]):
        case = mesokit.Case.from_toml(case_file, {FORCE: run.point[FORCE], "run.seed": run.seed})
        alone = mesokit.Simulation(case, threads=2)
        alone.run()
        assert mesokit.open(run.path).results == alone.results
        assert mesokit.open(run.path).provenance["resumed"] == []
    assert not list(study.path.rglob(".progress*"))


def test_what_has_ended_is_not_repeated(study, monkeypatch, case_file):
    """Nor when the study is opened, made again, or made larger."""
    before = {path: path.stat().st_mtime_ns for path in study.path.rglob("run.h5")}
    record = (study.path / "study.toml").read_text()

    def nobody(*given):
        raise AssertionError("a run was handed out")

    with monkeypatch.context() as patch:
        patch.setattr(local.Processes, "submit", nobody)
        study.run()
        Study.open(study.path).run()
    larger = Study(case_file, {FORCE: [0.02, 0.04, 0.06]}, seeds=3, output=study.path)
    assert [run.ended for run in larger.runs] == [True] * 6 + [False] * 3
    assert {path: path.stat().st_mtime_ns for path in study.path.rglob("run.h5")} == before
    with pytest.raises(RunError, match=r"holds a study with other runs, such as runs.acc.*=0\.06"):
        Study(case_file, {FORCE: [0.02, 0.04]}, seeds=3, output=study.path)
    for path in study.path.glob("runs/*=0.06"):
        shutil.rmtree(path)
    (study.path / "study.toml").write_text(record)  # as it was


def test_table_pools_the_seeds(study, tmp_path):
    rows = {(row.point[FORCE], row.name): row for row in study.table()}
    merged = mesokit.merge([run.path for run in study.runs[3:]], tmp_path / "merged")
    assert {(point, name) for point, name in rows if point == 0.04} == {
        (0.04, name) for name in merged.comparisons()
    }
    for name, number in merged.comparisons().items():  # ratios are those of all samples
        assert rows[0.04, name].number == number, name
    row = rows[0.04, "flow-rate.mean-velocity-along-x"]
    each = [
        mesokit.open(run.path)["flow-rate"]["mean velocity"]
        for run in study.runs
        if run.point[FORCE] == 0.04
    ]
    values, errors = np.array([(c.measured, c.error) for c in each]).T
    assert row.runs == 3 and row.each == tuple(each)
    assert row.number.measured == pytest.approx(values.mean())
    assert row.scatter == pytest.approx(values.std(ddof=1) / np.sqrt(3))
    assert row.seeds.dof == 2
    least = np.average(values, weights=1 / errors**2)
    assert row.seeds.chi2 == pytest.approx((((values - least) / errors) ** 2).sum())
    pandas = pytest.importorskip("pandas")
    frame = study.to_dataframe()
    with open(study.to_csv(tmp_path / "t.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(frame) == len(lines) == len(rows)
    assert float(lines[0][FORCE]) == 0.02 and lines[0]["result"] == "velocity-profile"
    assert [float(line["measured"]) for line in lines] == list(frame["measured"])
    assert "" in {line["deviation"] for line in lines}  # no theory yet: the flow had not built up
    assert "nan" not in {text for line in lines for text in line.values()}
    again = pandas.read_csv(tmp_path / "t.csv")
    numbers = ["measured", "error", "expected", "deviation", "percent", "scatter", "chi2", "p"]
    pandas.testing.assert_frame_equal(again[numbers], frame[numbers])


def test_another_case_in_its_place_is_refused(study, case_file, tmp_path):
    other = tmp_path / "other.toml"
    other.write_text(case_file.read_text().replace("density = 9.52", "density = 5"))
    with pytest.raises(RunError, match=r"holds a run with fluid\.density = 9\.52, not 5"):
        Study(other, {FORCE: [0.02, 0.04]}, seeds=3, output=study.path)


def test_runs_become_longer(case_file, tmp_path, study, here):
    """A study that is made again with more steps goes on; to fewer it cannot come."""
    first = Study(case_file, output=tmp_path / "s", settings={"run.steps": 60})
    first.run()
    longer = Study(case_file, output=tmp_path / "s")
    assert not longer.ended and not longer.runs[0].files.ended
    longer.run()
    assert longer.runs[0].files.results == study.runs[0].files.results
    assert "steps = 120" in longer.runs[0].files.provenance["case"]
    with pytest.raises(RunError, match=r"run\.steps = 120, which cannot be 60"):
        Study(case_file, output=tmp_path / "s", settings={"run.steps": 60})


def test_a_folder_that_was_removed_is_made_again(case_file, tmp_path, here):
    made = Study(case_file, output=tmp_path / "s", settings={"run.steps": 30})
    shutil.rmtree(made.runs[0].path)
    Study.open(tmp_path / "s").run()
    assert made.ended


def test_bad_values_make_no_folder(case_file, tmp_path):
    with pytest.raises(CaseError, match=r"with fluid\.density = -1: fluid\.density = -1"):
        Study(case_file, {"fluid.density": [5, -1]}, output=tmp_path / "s")
    with pytest.raises(CaseError, match="did you mean 'density'"):
        Study(case_file, {"fluid.densty": [5]}, output=tmp_path / "s")
    assert not (tmp_path / "s").exists()
    with pytest.raises(CaseError, match="seeds = 0: expected how many"):
        Study(case_file, seeds=0, output=tmp_path / "s")


def test_one_that_fails_does_not_stop_the_others(case_file, tmp_path, capsys):
    study = Study(case_file, {FORCE: [5000.0, 0.02]}, output=tmp_path / "s")
    told: list[int] = []

    class Watching(StudyReporter):
        def update(self, step: int) -> None:
            told.append(step)

    with pytest.raises(RunError, match=r"acceleration=5000/seed=5: .*particle moves at"):
        study.run(jobs=1, progress=Watching(quiet=True))
    one = 130 * sum(group.number for group in study.runs[0].files.case.groups)
    assert one <= max(told) < 2 * one  # the one that failed has not been carried to its end
    assert [run.ended for run in study.runs] == [False, True]
    code, out, err = said(capsys, "study", study.path, "--jobs", 1)
    assert code == 1 and "flow-rate: mean velocity" in out and "table:" in out
    assert "particle moves at" in err
    assert "particle moves at" in study.runs[0].failed
    assert len(study.table()) > 0


def test_info_prints_the_pooled_numbers(study, capsys):
    code, out, _ = said(capsys, "info", study.path)
    assert code == 0 and "6 of 6 runs have ended" in out
    assert all(line in out.splitlines() for line in study.lines())
    record = json.loads(said(capsys, "info", study.path, "--json")[1])
    assert record["varied"] == {FORCE: [0.02, 0.04]} and len(record["numbers"]) == len(
        study.table()
    )


def test_a_list_of_runs_writes_nothing(case_file, tmp_path, capsys, monkeypatch):
    """So that a later study of other settings finds no folder in its way."""
    monkeypatch.chdir(tmp_path)
    vary = ["study", case_file, "--vary", f"{FORCE}=0.01:0.03:5"]
    code, out, _ = said(capsys, *vary, "--set", "run.warmup=40", "--list")
    assert code == 0 and out.count("not begun") == 5 and not list(tmp_path.iterdir())
    with pytest.raises(CaseError, match=r"with .*acceleration = 1e\+400|acceleration = inf"):
        Study(case_file, {FORCE: [0.01, float("inf")]}, output="s", write=False)
    study = Study(case_file, {FORCE: [0.01, 0.03]}, output="s", write=False)
    assert [run.state for run in study.runs] == ["not begun"] * 2 and not Path("s").exists()
    monkeypatch.setattr("mesokit.study.study.drive", lambda runs, *rest: [])
    study.run()
    assert Study.open("s").keys == [FORCE] and all(run.files.case for run in study.runs)
    code, out, _ = said(capsys, *vary, "--list", "--output", "s")
    assert code == 0 and len(list(Path("s/runs").iterdir())) == 2


def test_runs_of_a_study_have_a_bound(case_file, tmp_path):
    """It is looked at before lists are made."""
    with pytest.raises(CaseError, match=r"seeds = 1000000000000: expected at most 100000"):
        Study(case_file, seeds=10**12, output=tmp_path / "s")
    vary = {"fluid.density": "1:2:1000", "fluid.timestep": "0.1:0.2:1000"}
    with pytest.raises(CaseError, match=r"1000000 runs: expected at most 100000 in a study"):
        Study(case_file, vary, output=tmp_path / "s")
    assert not (tmp_path / "s").exists()


def test_seeds_of_one_case(case_file, tmp_path, capsys, here):
    """`run --seeds` runs them, and shows what they say as one."""
    output = tmp_path / "seeds"
    steps = ["--set", "run.steps=60"]
    code, out, err = said(capsys, "run", case_file, "--seeds", 2, "--output", output, *steps)
    assert code == 0 and "mean velocity along x" in out
    assert "study: 2 of 2 runs to do" in err
    again = ["run", case_file, "--seeds", 2, "--output", output, "--overwrite"]
    code, _, err = said(capsys, *again)
    assert code == 2 and f"to begin anew, remove the folder {output}, or choose another" in err
    merged = mesokit.open(output / "runs" / "merged")
    assert merged["flow-rate"].samples == 14
    assert [entry["seed"] for entry in merged.provenance["merged"]] == [5, 6]
