"""Study files, and the processes that carry out their runs: progress, stops and clusters."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
import time
from concurrent.futures import Future
from pathlib import Path
from types import SimpleNamespace

import pytest

import mesokit
from mesokit import Box, Case, Run, Study
from mesokit.errors import CaseError, RunError
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.study import local
from mesokit.study.drive import StudyReporter, drive
from tests.helpers.lattices import lattice_case
from tests.helpers.studies import FORCE, said

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "studies"


LONG = 300  # seconds after which a test has failed


def test_study_files_and_the_command(case_file, tmp_path, capsys, monkeypatch, here):
    monkeypatch.chdir(tmp_path)
    text = f'case = "{case_file.as_posix()}"\nseeds = [5]\n[set]\n"run.steps" = 60\n'
    Path("forces.toml").write_text(f'{text}[[vary]]\n"{FORCE}" = "0.02:0.04:2"\n')
    code, out, _ = said(capsys, "study", "forces.toml", "--list")
    assert code == 0 and out.count("not begun") == 2 and "acceleration=0.04" in out
    code, out, _ = said(capsys, "study", "forces.toml", "--only", 2)
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
        ('case = "c.toml"\nset = "steps"', r"s.toml: set = 'steps': expected a table \[set\]"),
        ('case = "c.toml"\nfolder = [1]', r"s.toml: folder = \[1\]: expected the name of a folder"),
        ('case = "c.toml"\nseeds = 5_000_000', "s.toml: seeds = 5000000: expected at most 100000"),
        ('case = "c.toml"\n[set]\nbox = 2', "s.toml: box = 2: expected a table"),
        ('case = "c.toml"\n[set]\nrun = "a"', "s.toml: run = 'a': expected a table, with seed"),
        ('case = "c.toml"\n[[vary]]\nrun = [2]', "s.toml: with run = 2: run = 2: expected a table"),
        (
            'case = "c.toml"\n[[vary]]\n"run.seed" = [2]',
            "vary run.seed: expected seeds of the study",
        ),
    ],
)
def test_poor_study_files(case_file, tmp_path, text, words):
    (tmp_path / "c.toml").write_text(case_file.read_text())
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises((CaseError, RunError), match=words):
        Study.open(tmp_path / "s.toml")


def test_settings_of_a_study_file_need_no_quotes(case_file, tmp_path):
    """They replace values of a table, not the table."""
    (tmp_path / "c.toml").write_text(case_file.read_text())
    (tmp_path / "s.toml").write_text('case = "c.toml"\n[set]\nrun.steps = 30\nfluid.density = 7')
    case = Study.open(tmp_path / "s.toml", tmp_path / "s").runs[0].files.case
    assert (case.run.steps, case.run.warmup, case.fluid.density) == (30, 10, 7)
    assert Study.open(tmp_path / "s").base.case({}, 5) == case


def test_progress_is_told_once(capsys):
    """Not again where nothing has changed, as while figures are drawn."""
    reporter = StudyReporter(seconds=0.0)
    reporter.runs = 3
    reporter.start(100, 1, "study")
    reporter.began = 0.0
    for ended in (0, 0, 0, 1, 1):
        reporter.ended, reporter.next = ended, 0.0
        reporter.update(100)
    lines = capsys.readouterr().err.splitlines()
    what = "runs have ended, the last results and figures are being written"
    assert lines == [
        "study: 3 of 3 runs to do",
        *(f"study: 100 %, {n} of 3 {what}" for n in (0, 1)),
    ]


class NoWorkers:
    """One place, where no run goes far."""

    places = 1

    def submit(self, path):
        done = Future()
        done.set_result("lost")
        return done

    def stop(self):
        pass

    def close(self):
        pass


@pytest.mark.parametrize(
    "case, noun",
    [
        (lattice_case((8, 6), Ising(), steps=10), "site"),
        (Case(run=Run(steps=10), box=Box([8, 8])), "particle"),
    ],
)
def test_progress_counts_what_the_cases_have(case, noun):
    run = SimpleNamespace(
        files=SimpleNamespace(case=case), path=Path("run"), ended=False, step=0, failed="lost"
    )
    reporter = StudyReporter(quiet=True)
    reporter.rate = lambda: 2e6
    assert drive([run], NoWorkers(), reporter) == [(run, "lost")]
    assert f"2 M {noun}-steps/s" in reporter.words(0)


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
    """Workers end their runs at a checkpoint when the process that started them has gone."""
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
