"""Folders and starts that a run cannot have, and earlier runs that are replaced."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from mesokit.cli import main
from tests.helpers.damage import (
    SOURCE,
    contents,
    refusal,
)


@pytest.mark.parametrize("name", ["positions", "velocities"])
@pytest.mark.parametrize("content", ["no array", "wrong shape", "not finite", "texts"])
@pytest.mark.parametrize("command", ["check", "run"])
def test_wrong_start_arrays(
    command: str, name: str, content: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:

    if content == "no array":
        (folder / "start.npy").write_text("1 2 3")
    elif content == "texts":
        np.save("start.npy", np.full((640, 2), "x"))
    else:
        np.save("start.npy", np.full((640, 3 if content == "wrong shape" else 2), np.nan))
    message = refusal(capsys, command, "case.toml", "--set", f"fluid.start.{name}=start.npy")
    assert f"case.toml: fluid.start.{name}" in message


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize(
    ("settings", "words"),
    [
        (["fluid.density=11"], "(mass, number) [[1, 640]], this case [[1, 704]]"),
        (["fluid.mass=2"], "(mass, number) [[1, 640]], this case [[2, 640]]"),
        (["fluid.species=[{mass=1, density=5}, {mass=1, density=5}]"], "[[1, 320], [1, 320]]"),
        (["box.size=[16, 4]"], "that run has a box of [8, 8], this case [16, 4]"),
        (["box.size=[4, 4, 4]"], "that run has a box of [8, 8], this case [4, 4, 4]"),
        (["fluid.start.run=.."], "holds no run"),
        (["fluid.start.run=nowhere"], "no such folder"),
        (["fluid.start.run=unstarted"], "no such checkpoint"),
    ],
)
def test_start_from_a_run_that_does_not_fit(
    settings: list[str], words: str, command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "unstarted").mkdir()
    shutil.copy(folder / "case.toml", folder / "unstarted")
    options = [part for text in ["fluid.start.run=run", *settings] for part in ("--set", text)]
    message = refusal(capsys, command, "case.toml", "--output" if command == "run" else "--threads",
                      "1", *options)  # fmt: skip
    assert "case.toml: fluid.start.run = " in message
    assert words in message
    assert not (folder / "1").exists()


def test_folder_that_cannot_be_made(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = contents(folder)
    assert "case.toml" in refusal(capsys, "run", "case.toml", "--output", "case.toml/inside")
    assert contents(folder) == before


def test_folder_that_the_system_refuses(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without permission; root may write everywhere but under /proc."""
    if not hasattr(os, "geteuid"):
        pytest.skip("folders cannot be locked so")
    (folder / "locked").mkdir(mode=0o500)
    place = "/proc/run" if os.geteuid() == 0 else "locked/run"
    message = refusal(capsys, "run", "case.toml", "--output", place)
    assert f"{place}: cannot make the folder: " in message


def test_full_disk(folder: Path) -> None:
    """A limit on the size of files stands for a disk without space."""
    resource = pytest.importorskip("resource")
    before = contents(folder)
    done = subprocess.run(
        [sys.executable, "-m", "mesokit", "run", "case.toml", "--output", "new", "--quiet",
         "--set", "trajectory.precision=float64", "--set", "fluid.density=50"],
        env=os.environ | {"PYTHONPATH": SOURCE},
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000)),
    )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr.startswith("mesokit: error: ")
    assert done.stderr.count("\n") == 1
    assert {k: v for k, v in contents(folder).items() if "/new/" not in k} == before


def test_overwrite_replaces_a_run(folder: Path) -> None:
    with pytest.raises(SystemExit) as end:
        main(["run", "case.toml", "--output", "run", "--overwrite", "--quiet", "--seed", "3"])
    assert not end.value.code
    assert "seed = 3" in (folder / "run" / "case.toml").read_text()


@pytest.mark.parametrize("removals", range(0, 9, 2))
def test_overwrite_may_be_killed_and_repeated(
    folder: Path, monkeypatch: pytest.MonkeyPatch, removals: int
) -> None:
    """What is removed last is the case, by which the folder is known as that of a run."""
    unlink, done = Path.unlink, []

    def killed(path: Path, missing_ok: bool = False) -> None:
        if path.exists() and path.parent.name == "run":
            done.append(path.name)
            if len(done) > removals:
                raise KeyboardInterrupt
        unlink(path, missing_ok=missing_ok)

    words = ["run", "case.toml", "--output", "run", "--overwrite", "--quiet"]
    with monkeypatch.context() as limited, pytest.raises(SystemExit):
        limited.setattr(Path, "unlink", killed)
        main(words)
    assert done
    with pytest.raises(SystemExit) as end:
        main(words)
    assert not end.value.code
    assert (folder / "run" / "run.h5").exists()


def test_overwrite_spares_other_files(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "run" / "log-damaged.csv").write_text("of the run")
    (folder / "run" / "notes.txt").write_text("precious")
    before = contents(folder)
    message = refusal(capsys, "run", "case.toml", "--output", "run", "--overwrite")
    assert "notes.txt" in message
    assert contents(folder) == before
