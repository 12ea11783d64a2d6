"""What a run does while its kernels are compiled for the first time."""

import ctypes
import dataclasses
import os
import queue
import signal
import subprocess
import sys
from pathlib import Path

import numba
import pytest

import mesokit
from mesokit import AT, Box, Case, Conservation, Fluid, Plates, Run, Simulation
from mesokit.case import kind
from mesokit.case.methods import templates
from mesokit.kernels.kept import Counts
from mesokit.kernels.store import Store
from mesokit.processes.signals import Stopped
from mesokit.run import loop

SOURCE = str(Path(mesokit.__file__).parent.parent)
CASE = """
run = { steps = 20 }
box = { size = [6, 6] }
"""


def command(folder, *arguments, **environment):
    """A process with an empty cache of kernels."""
    places = {"PYTHONPATH": SOURCE, "XDG_CACHE_HOME": str(folder / "cache")}
    return subprocess.Popen(
        [sys.executable, "-m", "mesokit", *map(str, arguments)],
        env=os.environ | places | environment, cwd=folder,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


@pytest.fixture
def case_file(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


def test_interrupted_while_compiling(case_file, tmp_path):
    """The process ends at once, and its folder holds a run that can be gone on with."""
    process = command(tmp_path, "run", case_file, "--threads", "2")
    said = ""
    while "compiling" not in said and (line := process.stderr.readline()):
        said += line
    assert "compiling" in said, said
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate()
    assert process.returncode == 130, errors
    assert "stopped at step 0, while compiling, by SIGINT" in errors
    assert "mesokit resume case" in errors and "Traceback" not in errors
    written = {path.name for path in (tmp_path / "case").iterdir()}
    assert written == {".lock", "case.toml", "provenance.json"}


@pytest.mark.parametrize("fails", [True, False])
def test_a_signal_that_the_compiler_does_not_hand_on(fails, case_file, monkeypatch, capsys):
    """It calls back into Python, which writes out and drops what is raised there; then it fails."""
    simulation = Simulation(case_file, threads=1)

    def compiles(steps):
        ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(signal.SIGTERM))()
        if fails:
            raise RuntimeError("no compiled object yet")

    monkeypatch.setattr(simulation.engine, "advance", compiles)
    with pytest.raises(Stopped, match="stopped at step 0, while compiling, by SIGTERM"):
        simulation.run(progress=False)
    assert capsys.readouterr().err == ""


def test_a_case_without_solids_is_checked_without_compiling(tmp_path):
    for template in ("poiseuille", "shear"):
        (tmp_path / f"{template}.toml").write_text(templates()[template].read_text("utf-8"))
        process = command(tmp_path, "check", f"{template}.toml")
        _, errors = process.communicate()
        assert process.returncode == 0, errors
        [store] = (tmp_path / "cache").rglob("*.sqlite")
        assert sum(Store(store).counts().values()) == 0, template


def test_kinds_of_cases(monkeypatch, tmp_path):
    """Those that differ in numbers alone, or in what is measured, run the same kernels."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr("mesokit.kernels.kernel._used", set())
    monkeypatch.setattr("mesokit.kernels.kept._now", [])
    case = Case(run=Run(steps=5), box=Box([6, 6]), fluid=Fluid())
    assert not kind.has_run(case)
    kind.note_run(case)
    same = Case(
        run=Run(steps=9, seed=4), box=Box([12, 8]), fluid=Fluid(density=4.5, timestep=0.2),
        title="other",
    )  # fmt: skip
    assert kind.has_run(case) and kind.has_run(same)
    for other in (
        dataclasses.replace(case, box=Box([6, 6, 6])),
        dataclasses.replace(case, box=Box([6, 6], shear_rate=0.1)),
        dataclasses.replace(case, fluid=Fluid(collision=AT())),
        dataclasses.replace(case, walls=(Plates(axis="y"),)),
        dataclasses.replace(case, observe=(Conservation(every=3),)),
    ):
        assert not kind.has_run(other)


def test_check_says_that_compiling_is_ahead(case_file, tmp_path):
    told, _ = command(tmp_path, "check", case_file).communicate()
    told = " ".join(told.split())
    assert "first start some seconds compiling, once for each kind of case" in told
    assert "up to a minute where nothing is kept yet" in told
    assert "290 MB while it compiles, the first time" in told


def test_what_is_done_before_the_first_step_is_said_when_it_changes(monkeypatch):
    """A start that only loads kernels is never said to compile."""
    counts, said = Counts(), queue.SimpleQueue()
    monkeypatch.setattr(loop, "counts", counts)
    monkeypatch.setattr(loop, "SILENT", 0.001)
    with loop.telling(said.put):
        assert said.get() == "loading kernels, or waiting for another process that compiles them"
        counts.kernels_found = 1
        assert said.get() == "loading kernels"
        counts.parts_found = 7
        assert said.get() == "compiling from parts that are kept (once)"
        counts.parts_made = 1
        assert said.get() == "compiling (once; kept for the next runs)"
    assert said.empty()
