"""Studies: runs that are those of their cases, a table, pictures, stops."""

from __future__ import annotations

import contextlib
import csv
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import mesokit
from mesokit import Study
from mesokit.cli import main
from mesokit.errors import CaseError, RunError
from mesokit.study import local
from mesokit.study.drive import StudyReporter

FORCE = "fluid.force.acceleration"
EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "studies"
LONG = 300  # seconds after which a test has failed


def said(capsys, *arguments) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as end:
        main([str(a) for a in arguments])
    out = capsys.readouterr()
    return int(end.value.code or 0), out.out, out.err


@pytest.fixture(scope="module")
def study(case_file, tmp_path_factory) -> Study:
    """Two forces, three seeds, two at once."""
    output = tmp_path_factory.mktemp("studies") / "study"
    study = Study(case_file, {FORCE: [0.02, 0.04]}, seeds=3, output=output)
    study.run(jobs=2)
    return study


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
    row = rows[0.04, "flow-rate.mean-velocity-along-x"]
    each = [
        mesokit.open(run.path)["flow-rate"]["mean velocity"]
        for run in study.runs
        if run.point[FORCE] == 0.04
    ]
    values, errors = np.array([(c.measured, c.error) for c in each]).T
    assert row.runs == 3 and row.number.measured == pytest.approx(values.mean())
    assert row.number.error == pytest.approx(np.sqrt((errors**2).sum()) / 3)
    assert row.number.expected == pytest.approx(each[0].expected)
    assert row.scatter == pytest.approx(values.std(ddof=1) / np.sqrt(3))
    assert row.seeds.dof == 2
    assert row.seeds.chi2 == pytest.approx((((values - values.mean()) / errors) ** 2).sum())
    frame = study.to_dataframe()
    with open(study.to_csv(tmp_path / "t.csv"), newline="") as file:
        lines = list(csv.DictReader(file))
    assert len(frame) == len(lines) == len(rows)
    assert float(lines[0][FORCE]) == 0.02 and lines[0]["result"] == "flow-rate"
    assert [float(line["measured"]) for line in lines] == list(frame["measured"])


def test_pictures(study):
    """Points with error bars, theory, and a fit that finds what the data say."""
    from mesokit.study.dependence import Curve, fitted

    figure = study.plot("acceleration", "flow-rate.mean", fit="line")
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert (
        labels[0] == "theory of the steady flow, not reached"
        and labels[1].startswith("fit: $y = ")
        and "3 runs" in labels[2]
    )
    assert figure.axes[0].get_xlabel() == r"acceleration  [$a/\tau^2$]"
    x = np.array([1.0, 2.0, 4.0, 8.0])
    curve = Curve("", x, 3 * x**-0.5, 0.01 * x, np.full(4, np.nan))
    found = fitted(curve, "power")
    assert found.fit.coefficients == pytest.approx([np.log(3), -0.5])
    assert found.formula.startswith("y = 3.00") and " x^-0.500(" in found.formula
    assert r"\,x^{-0.500(" in found.legend
    assert found(x) == pytest.approx(3 * x**-0.5)
    [line] = study.fit("acceleration", "flow-rate.mean", "line")
    assert line.formula.replace(" x", r"\,x") in labels[1]
    with pytest.raises(CaseError, match=r"density: not varied; expected 'acceleration'"):
        study.plot("density", "flow-rate.mean")
    with pytest.raises(CaseError, match=r"did you mean 'flow-rate\.mean-velocity"):
        study.plot("acceleration", "flow-rate.man-velocity-along-x")
    with pytest.raises(CaseError, match=r"fit = 'cubic': expected 'line' or 'power'"):
        study.plot("acceleration", "flow-rate.mean", fit="cubic")


@pytest.mark.parametrize(("log", "power", "joined"), [
    (False, 1, True), (True, 2, True), (False, 2, False), (True, 0, True), (False, 0, True),
])  # fmt: skip
def test_theory_is_drawn_between_points_where_it_is_straight(log, power, joined):
    """Elsewhere straight pieces would be what no theory says."""
    from mesokit.study.dependence import Curve, draw

    x = np.array([1.0, 2.0, 4.0, 8.0])
    curve = Curve("", x, 3 * x**power, 0.1 * x, 3 * x**power)
    ax = draw([curve], ("x", ""), ("y", ""), log=log).axes[0]
    theory = next(line for line in ax.lines if line.get_label() == "theory")
    assert (theory.get_linestyle() != "None") == joined


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


def test_study_files_and_the_command(case_file, tmp_path, capsys, monkeypatch, here):
    monkeypatch.chdir(tmp_path)
    text = f'case = "{case_file.as_posix()}"\nseeds = [5]\n[set]\n"run.steps" = 60\n'
    Path("forces.toml").write_text(f'{text}[[vary]]\n"{FORCE}" = "0.02:0.04:2"\n')
    code, out, _ = said(capsys, "study", "forces.toml", "--list")
    assert code == 0 and out.count("not begun") == 2 and "acceleration=0.04" in out
    code, out, _ = said(capsys, "study", "forces", "--only", 2)
    assert code == 0 and said(capsys, "study", "forces", "--list")[1].count("ended") == 1
    code, out, err = said(capsys, "study", "forces", "--jobs", 1)
    assert code == 0 and "study: 2 of 2 runs" in err
    assert "acceleration = 0.04 (1 run)" in out and "table: forces" in out
    assert Path("forces/flow-rate.mean-velocity-along-x-against-acceleration.png").exists()
    assert Study.open("forces").runs[0].files.case.run.steps == 60
    y = "flow-rate.mean-velocity"
    code, out, _ = said(capsys, "study", "forces", "--y", y, "--fit", "line", "--quiet")
    assert (
        code == 0 and "fit: y = " in out and "mean-velocity-along-x-against-acceleration.png" in out
    )
    code, out, _ = said(capsys, "study", "forces", "--job-array", "--threads", 2)
    script = Path("forces/job-array.sh").read_text()
    assert "--array=1-2" in script and "--cpus-per-task=2" in script
    assert subprocess.run(["bash", "-n", "forces/job-array.sh"]).returncode == 0
    for arguments, words in (
        (["forces", "--seeds", 2], "--seeds: only with a case file"),
        (["forces", "--only", 3], "--only 3: the study has 2 runs"),
        (["forces", "--fit", "line"], "--fit: of which number?"),
        (["forces", "--y", "flow-rat.mean"], "expected 'velocity-profile' or 'flow-rate'"),
        (["forces", "--x", "nix", "--y", y], "nix: not varied; expected 'acceleration'"),
        ([tmp_path / "nowhere"], "no such file"),
    ):
        code, _, err = said(capsys, "study", *arguments)
        assert code == 2 and words in err and "\n" not in err.strip(), err


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_examples_can_be_run(file, tmp_path):
    study = Study.open(file, output=tmp_path / "s")
    assert len(study) > 1 and not any("average over the start" in w for w in study.warnings())


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("seeds = 2", "case = None: expected the name of a case file"),
        ('case = "c.toml"\nsead = 2', "sead: unknown key; did you mean 'seeds'"),
        ('case = "c.toml"\nvary = 3', r"expected \[\[vary\]\], in double brackets"),
        ('case = "nowhere.toml"', "nowhere.toml: no such file"),
    ],
)
def test_poor_study_files(case_file, tmp_path, text, words):
    (tmp_path / "c.toml").write_text(case_file.read_text())
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises((CaseError, RunError), match=words):
        Study.open(tmp_path / "s.toml")


def test_seeds_of_one_case(case_file, tmp_path, capsys, here):
    """`run --seeds` runs them, and shows what they say as one."""
    output = tmp_path / "seeds"
    steps = ["--set", "run.steps=60"]
    code, out, _ = said(capsys, "run", case_file, "--seeds", 2, "--output", output, *steps)
    assert code == 0 and "mean velocity along x" in out
    merged = mesokit.open(output / "runs" / "merged")
    assert merged["flow-rate"].samples == 14
    assert [entry["seed"] for entry in merged.provenance["merged"]] == [5, 6]


def begun(study: Path, number: int, process: subprocess.Popen[str]) -> list[Path]:
    """Waits until so many runs have gone some steps."""
    end = time.monotonic() + LONG
    while time.monotonic() < end:
        found = [path for path in study.rglob(".progress") if int(path.read_text() or 0) > 50]
        if len(found) >= number:
            return [path.parent for path in found]
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.05)
            raise AssertionError("it ended too early")
    raise AssertionError("no run has begun")


def start(case_file: Path, output: Path) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "mesokit", "study", str(case_file), "--seeds", "2"]
    command += ["--set", "run.steps=60000", "--output", str(output), "--jobs", "2"]
    return subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_stopped_study_goes_on(case_file, tmp_path, study):
    """Runs in hand end at a checkpoint; the status says which signal it was."""
    process = start(case_file, tmp_path / "s")
    runs = begun(tmp_path / "s", 2, process)
    process.send_signal(signal.SIGTERM)
    _, err = process.communicate(timeout=LONG)
    assert process.returncode == 143, err
    assert "stopped by SIGTERM: 0 of 2 runs have ended; go on with: mesokit study" in err
    for run in runs:
        files = mesokit.open(run)
        assert not files.ended and files.results["flow-rate"].samples > 1
    assert not list(tmp_path.rglob(".progress"))


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_runs_do_not_outlive_a_study_that_is_killed(case_file, tmp_path, study):
    """When nobody is there to ask them, workers end their runs at a checkpoint."""
    process = start(case_file, tmp_path / "s")
    runs = begun(tmp_path / "s", 2, process)
    process.kill()
    process.communicate(timeout=LONG)
    end = time.monotonic() + LONG
    while list((tmp_path / "s").rglob(".progress")):
        assert time.monotonic() < end
    for run in runs:
        assert not mesokit.open(run).ended and (run / "checkpoint.npz").exists()


def test_parts_of_a_script_run_in_its_own_process(case_file, tmp_path, monkeypatch):
    from mesokit.study import study as module

    monkeypatch.setattr(module, "outside_parts", lambda case: [{"class": "__main__:Mine"}])
    made = Study(case_file, seeds=2, output=tmp_path / "s", settings={"run.steps": 30})
    with pytest.raises(CaseError, match="put them into a module"):
        made.run(jobs=2)
    monkeypatch.setattr(local.Processes, "submit", None)
    made.run()
    assert made.ended


def test_dask(case_file, tmp_path, study):
    """The same bits by way of a cluster of Dask on this machine."""
    other = Study(case_file, {FORCE: [0.02, 0.04]}, seeds=1, output=tmp_path / "s")
    other.run(jobs=2, cluster="local")
    assert [run.files.results for run in other.runs] == [
        run.files.results for run in study.runs if run.seed == 5
    ]
