"""Runs whose files are damaged, lost or swapped: one line, no traceback, nothing made worse."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from mesokit.cli import main
from tests.helpers.damage import (
    ANEW,
    CASE,
    contents,
    empty,
    flipped,
    flipped_anywhere,
    main_ends,
    refusal,
    truncated,
)


@pytest.mark.parametrize("damage", [truncated, flipped, empty])
def test_damaged_checkpoint(damage, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    checkpoint = folder / "run" / "checkpoint.npz"
    checkpoint.write_bytes(damage(checkpoint.read_bytes()))
    before = contents(folder)
    assert "checkpoint.npz" in refusal(capsys, "resume", "run")
    assert contents(folder) == before


@pytest.mark.parametrize("name", ["positions", "velocities"])
def test_checkpoint_without_numbers(name, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    checkpoint = folder / "run" / "checkpoint.npz"
    with np.load(checkpoint) as file:
        arrays = dict(file)
    arrays[f"engine/{name}"][3] = np.nan
    np.savez(checkpoint, **arrays)
    assert f"{name} that are no numbers" in refusal(capsys, "resume", "run")


def test_checkpoint_of_another_case(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    shutil.copy(folder / "other" / "checkpoint.npz", folder / "run" / "checkpoint.npz")
    before = contents(folder)
    message = refusal(capsys, "resume", "run")
    assert "another case" in message
    assert "fluid.start.run = 'run'" in message
    assert contents(folder) == before


def test_case_changed_after_the_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = folder / "run" / "case.toml"
    case.write_text(case.read_text().replace("density = 10", "density = 11"))
    before = contents(folder)
    assert "case" in refusal(capsys, "resume", "run")
    assert contents(folder) == before


def test_broken_case_in_a_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "run" / "case.toml").write_text("[run")
    for command in ("resume", "info"):
        assert "case.toml" in refusal(capsys, command, "run")


@pytest.mark.parametrize("command", ["info", "plot"])
@pytest.mark.parametrize("damage", [truncated, flipped_anywhere, empty])
def test_damaged_results(
    damage, command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = folder / "run" / "run.h5"
    results.write_bytes(damage(results.read_bytes()))
    message = refusal(capsys, command, "run")
    assert "run.h5: damaged" in message
    assert message.endswith(f"put a copy in its place, or run anew: {ANEW}\n")


@pytest.mark.parametrize("command", ["info", "plot"])
def test_what_to_do_about_damaged_results(
    command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Without a trajectory, all that is needed is in the checkpoint."""
    shutil.rmtree("run")
    Path("plain.toml").write_text(CASE.partition("[trajectory]")[0])
    main_ends(["run", "plain.toml", "--output", "run", "--quiet"])
    results = folder / "run" / "run.h5"
    results.write_bytes(b"")
    assert refusal(capsys, command, "run").endswith("; mesokit resume run writes it again\n")
    main_ends(["resume", "run", "--quiet"])
    main_ends([command, "run"])
    results.write_bytes(b"")
    (folder / "run" / "checkpoint.npz").unlink()
    assert refusal(capsys, command, "run").endswith(f"or run anew: {ANEW}\n")


@pytest.mark.parametrize("command", ["info", "plot"])
def test_what_to_do_about_lost_results(
    command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "run" / "run.h5").unlink()
    if command == "info":
        main_ends(["info", "run"])
        message = capsys.readouterr().out
    else:
        main_ends([command, "run"])  # with what the checkpoint has
        message = capsys.readouterr().err
    assert "mesokit resume" not in message
    assert "cannot go on: its last checkpoint is at step 20 of 20, but " in message
    assert "run/trajectory: 5 of 5 frames are missing" in message
    assert f"run anew: {ANEW}" in message
    main_ends(ANEW.split()[1:] + ["--quiet"])


@pytest.mark.parametrize("damage", [truncated, flipped_anywhere, empty])
def test_the_frames_are_only_in_the_data_file(
    damage, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    results = folder / "run" / "run.h5"
    results.write_bytes(damage(results.read_bytes()))
    before = contents(folder)
    message = refusal(capsys, "resume", "run")
    assert "run/run.h5: damaged" in message
    assert "mesokit run run/case.toml --output run --overwrite" in message
    assert contents(folder) == before


def test_lost_data_file(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "run" / "run.h5").unlink()
    message = refusal(capsys, "resume", "run")
    assert "run/trajectory: 5 of 5 frames are missing, the first that of step 0" in message


def test_lost_checkpoint(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "run" / "checkpoint.npz").unlink()
    assert "checkpoint.npz: no such checkpoint" in refusal(capsys, "resume", "run")
    (folder / "run" / "run.h5").unlink()
    with pytest.raises(SystemExit) as end:
        main(["resume", "run", "--threads", "1"])
    assert not end.value.code
    assert "starting from step 0" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["info", "plot", "resume"])
def test_a_run_that_failed_says_why(
    command: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ["--set", "fluid.force={ rule = 'uniform', acceleration = [1e9, 0] }"]
    said = refusal(capsys, "run", "case.toml", "--output", "hot", "--quiet", *options)
    assert "heats up: add a thermostat, or lower the force or the velocity of the surfaces" in said
    if command == "info":
        main_ends(["info", "hot"])
        assert "failed: step 20: a particle moves" in capsys.readouterr().out
    else:
        assert "heats up" in refusal(capsys, command, "hot", *["--quiet"] * (command == "resume"))


def test_a_run_that_had_ended_is_not_said_to_run(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "run" / "conservation.png").unlink()
    with pytest.raises(SystemExit) as end:
        main(["resume", "run"])
    said = capsys.readouterr().err
    assert not end.value.code and "running" not in said
    assert "run: had ended at step 20; drawing its figures again" in said
    assert (folder / "run" / "conservation.png").exists()


def rewritten(folder: Path, save=np.savez, **changes: object) -> None:
    """The checkpoint of a run with other arrays, all bytes of which are whole."""
    file = folder / "run" / "checkpoint.npz"
    with np.load(file) as archive:
        arrays = dict(archive)
    save(file, **{**arrays, **changes})


METAS = ({}, [4], {"step": "x", "looked": True}, {"step": -1}, {"step": 2.5}, {"step": 10**9})


@pytest.mark.parametrize("meta", METAS, ids=map(str, METAS))
def test_a_checkpoint_of_another_meta(meta, folder: Path, capsys) -> None:
    with np.load(folder / "run" / "checkpoint.npz") as archive:
        header = json.loads(str(archive["meta"]))
    rewritten(folder, meta=np.array(json.dumps(header | {"meta": meta})))
    assert "checkpoint.npz: " in refusal(capsys, "resume", "run")
    (folder / "run" / "run.h5").unlink()
    with pytest.raises(SystemExit) as end:
        main(["info", "run"])
    assert end.value.code in (None, 0, 1)
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("change", ["no dimensions", "int8", "half"])
@pytest.mark.parametrize("name", ["engine/positions", "observe/conservation/blocks/sums"])
def test_a_checkpoint_of_other_arrays(name, change, folder: Path, capsys) -> None:
    with np.load(folder / "run" / "checkpoint.npz") as archive:
        good = archive[name]
    other = {
        "no dimensions": np.array(3.0),
        "int8": np.zeros(good.shape, np.int8),
        "half": good[: len(good) // 2],
    }[change]
    if name.startswith("engine") and change == "int8":
        return  # which is as good as zeros
    rewritten(folder, **{name: other})
    assert "checkpoint.npz: " in refusal(capsys, "resume", "run")


def test_a_checkpoint_is_not_compressed(folder: Path, capsys) -> None:
    """Else it might be many times as large as the file."""
    rewritten(folder, save=np.savez_compressed)
    for command in ("resume", "info"):
        (folder / "run" / "run.h5").unlink(missing_ok=True)
        assert "checkpoint.npz: damaged" in refusal(capsys, command, "run")


def test_results_of_another_shape(folder: Path, capsys) -> None:
    results = folder / "run" / "run.h5"
    with h5py.File(results, "r+") as file:
        name = next(iter(file["results"]))
        del file["results"][name]
        file["results"][name] = np.arange(3)
    assert "run.h5: damaged" in refusal(capsys, "info", "run")
