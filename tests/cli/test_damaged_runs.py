"""Runs whose files are damaged, lost or swapped: one line, no traceback, nothing made worse."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

from mesokit.cli import main

CASE = """
[run]
steps = 20
[box]
size = [8, 8]
[fluid]
density = 10
[[observe]]
quantity = "conservation"
every = 2
[trajectory]
every = 5
"""
ANEW = "mesokit run run/case.toml --output run --overwrite"
SOURCE = str(Path(__file__).parents[2] / "src")


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a case, a run of it, and a run with another seed."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "case.toml").write_text(CASE)
    for name, seed in (("run", 1), ("other", 2)):
        with pytest.raises(SystemExit) as end:
            main(["run", str(folder / "case.toml"), "--seed", str(seed), "--quiet",
                  "--output", str(folder / name)])  # fmt: skip
        assert not end.value.code
    return folder


@pytest.fixture
def folder(finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of it to damage."""
    shutil.copytree(finished, tmp_path / "copy")
    monkeypatch.chdir(tmp_path / "copy")
    return tmp_path / "copy"


def contents(folder: Path) -> dict[str, bytes]:
    return {str(p): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def refusal(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    capsys.readouterr()
    with pytest.raises(SystemExit) as end:
        main(list(arguments))
    assert end.value.code in (1, 2)
    captured = capsys.readouterr()
    assert captured.err.startswith("mesokit: error: ")
    assert captured.err.count("\n") == 1
    return captured.err


def truncated(data: bytes) -> bytes:
    return data[: len(data) // 2]


def flipped(data: bytes) -> bytes:
    middle = len(data) // 2
    return data[:middle] + bytes(255 - b for b in data[middle : middle + 64]) + data[middle + 64 :]


def flipped_anywhere(data: bytes) -> bytes:
    """Whole at its start and of the right length, nonsense from there on."""
    return data[:2048] + bytes(255 - b for b in data[2048:])


def empty(data: bytes) -> bytes:
    return b""


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


@pytest.mark.parametrize("damage", [truncated, flipped, empty])
def test_a_damaged_record_does_not_block(
    damage, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = folder / "run" / "provenance.json"
    record.write_bytes(damage(record.read_bytes()))
    (folder / "run" / "run.h5").rename("run.h5")
    main_ends(["info", "run"])
    Path("run.h5").rename(folder / "run" / "run.h5")
    main_ends(["resume", "run", "--quiet"])
    said = capsys.readouterr().err
    assert said.startswith("warning: run/provenance.json: cannot be read")
    assert said.endswith("; going on with a fresh record\n")
    assert len(json.loads(record.read_text())["resumed"]) == 1
    main_ends(["resume", "run", "--quiet"])
    assert capsys.readouterr().err == ""


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


@pytest.mark.parametrize("name", ["positions", "velocities"])
@pytest.mark.parametrize("content", ["no array", "wrong shape", "not finite", "texts"])
@pytest.mark.parametrize("command", ["check", "run"])
def test_wrong_start_arrays(
    command: str, name: str, content: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import numpy as np

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


def main_ends(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert not end.value.code


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


RECORDS: dict[str, object] = {
    "list": [1],
    "text": "a",
    "nothing": {},
    "parts": {"parts": [{}]},
    "family": {"parts": [{"family": "mesokit.case.box:Box", "name": "a", "class": "b"}]},
    "family of nothing": {"parts": [{"family": "mesokit.no:No", "name": "a", "class": "b"}]},
    "resumed": {"resumed": 5},
    "resumed when": {"resumed": [7]},
    "lengthened": {"lengthened": [{"at": "now"}]},
    "timings": {"timings": {"steps": "long"}},
    "versions": {"versions": None},
    "merged": {"merged": [1]},
    "ranks": {"ranks": "two", "shared_work": {}},
    "shared": {"shared_work": {"stages": {}}},
    "units": {"units": 3},
    "failed": {"failed": {"why": 1}},
    "sources": {"sources": [2]},
    "command": {"command": "mesokit"},
}


@pytest.mark.parametrize("whole", [False, True], ids=["changed", "alone"])
@pytest.mark.parametrize("name", RECORDS)
def test_a_record_of_another_shape(name, whole, folder: Path, capsys, monkeypatch) -> None:
    """Whatever it is, each command ends in one line or does its work."""
    monkeypatch.setattr("mesokit.report.save_all", lambda *given, **more: [])
    record = folder / "run" / "provenance.json"
    given = RECORDS[name]
    known = {} if whole else json.loads(record.read_text())
    changed = known | given if isinstance(given, dict) else given
    for arguments in (["info", "run"], ["resume", "run", "--steps", "30", "--quiet"]):
        record.write_text(json.dumps(changed))
        capsys.readouterr()
        with pytest.raises(SystemExit) as end:
            main(arguments)
        said = capsys.readouterr().err
        assert end.value.code in (None, 0, 1, 2)
        assert "Traceback" not in said
        if end.value.code:
            assert said.startswith("mesokit: error: ") and said.count("\n") == 1


def test_a_record_of_many_brackets(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "run" / "provenance.json").write_text("[" * 100_000)
    main_ends(["resume", "run", "--quiet"])
    assert "provenance.json: cannot be read: maximum recursion" in capsys.readouterr().err
    assert json.loads((folder / "run" / "provenance.json").read_text())["seed"] == 1


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


@pytest.mark.parametrize("text", [None, "{}", " {}\n"])
@pytest.mark.parametrize("more", [[], ["--steps", "30"]])
def test_a_lost_record_is_told_and_begun_anew(
    text, more: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = folder / "run" / "provenance.json"
    record.unlink() if text is None else record.write_text(text)
    how = "missing" if text is None else "empty"
    said = f"warning: run/provenance.json: {how}: what made this run is not known"
    main_ends(["info", "run"])
    assert f"\n  {said}\n" in capsys.readouterr().out
    main_ends(["resume", "run", "--quiet", *more])
    assert capsys.readouterr().err == f"{said}; going on with a fresh record\n"
    assert {"versions", "case", "seed"} <= set(json.loads(record.read_text()))
    main_ends(["info", "run"])
    assert "not known" not in capsys.readouterr().out


def test_info_tells_how_long_a_run_was(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main_ends(["info", "run"])
    lines = capsys.readouterr().out.splitlines()
    ended = json.loads((folder / "run" / "provenance.json").read_text())["ended"]
    date = ended.replace("T", " ").replace("+00:00", " UTC")
    assert lines[1] == f"  20 steps, to time 2; ended {date}"
    assert "untitled" not in "".join(lines)


def test_a_run_that_has_not_begun_lacks_no_record(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for file in (folder / "run").iterdir():
        if file.is_file() and file.name != "case.toml":
            file.unlink()
    main_ends(["info", "run"])
    main_ends(["resume", "run", "--quiet"])
    said = capsys.readouterr()
    assert "not known" not in said.out and said.err == ""
