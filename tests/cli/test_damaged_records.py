"""Records of runs that are damaged, lost or of another shape."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mesokit.cli import main
from tests.helpers.damage import (
    empty,
    flipped,
    main_ends,
    truncated,
)


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
