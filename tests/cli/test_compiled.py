"""The commands warm and cache."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from mesokit.case.methods import examples, templates
from mesokit.kernels.kept import shipped_file
from mesokit.run.warm import STEPS, shortened

CASE = "run = { steps = 1000 }\nbox = { size = [6, 6] }\n"


def mesokit(folder: Path, *words: str) -> str:
    """What a command says, with a store of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "mesokit", *words], cwd=folder, capture_output=True, text=True,
        env=os.environ | {"NUMBA_CACHE_DIR": str(folder / "kernels")}, timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_what_was_warmed_is_there_until_it_is_cleared(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    first = mesokit(tmp_path, "warm", "case.toml", "--why")
    assert "it was not made before" in first and "case.toml: 0 kernels" not in first
    assert "case.toml: 0 kernels, 0 parts" in mesokit(tmp_path, "warm", "case.toml")
    assert {path.name for path in tmp_path.iterdir()} == {"case.toml", "kernels"}
    shown = " ".join(mesokit(tmp_path, "cache").split())
    place = tmp_path / "kernels" / "mesokit" / "compiled-1.sqlite"
    assert shown.startswith(f"store: {place} ") and shown.endswith(f" {shipped_file()}")
    assert "kinds of case 1" in shown and "kernels 0" not in shown
    exported = mesokit(tmp_path, "cache", "--export", "parts.sqlite")
    assert not exported.startswith("0 parts") and (tmp_path / "parts.sqlite").exists()
    assert mesokit(tmp_path, "cache", "--clear").startswith("cleared")
    assert "kernels 0" in " ".join(mesokit(tmp_path, "cache").split())


def test_to_clear_and_to_export_are_two_things(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "mesokit", "cache", "--clear", "--export", "parts.sqlite"]
    done = subprocess.run(
        words, cwd=tmp_path, capture_output=True, text=True, timeout=300,
        env=os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kernels")},
    )  # fmt: skip
    assert done.returncode != 0 and "expected one of them" in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", sorted(templates() | examples()))
def test_each_case_is_shortened_for_it(name: str) -> None:
    case = shortened(Path(str((templates() | examples())[name])), {})
    assert case.run.steps == STEPS and case.run.warmup == 0
