"""Working directories of commands: an empty one, and one with runs to damage."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from mesokit.cli import main
from tests.helpers.damage import CASE


@pytest.fixture
def empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Work in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="session")
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
