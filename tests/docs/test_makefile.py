"""What `make` leaves to the background."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

MAKEFILE = Path(__file__).resolve().parents[2] / "Makefile"
STAND_IN = """#!/bin/sh
echo "$(nice) $1 $2" >> calls
if [ "$1" = warm ]; then cat go-on; fi
"""


@pytest.mark.skipif(os.name == "nt" or shutil.which("make") is None, reason="no make here")
def test_a_clone_makes_its_parts_once_its_first_run_has_ended(tmp_path: Path) -> None:
    """Nothing waits for them: here they are not made before the test lets them."""
    shutil.copy(MAKEFILE, tmp_path)
    for name in ("mesokit", "python"):
        (tmp_path / name).write_text(STAND_IN)
        (tmp_path / name).chmod(0o755)
    os.mkfifo(tmp_path / "go-on")
    demo = ["make", "-o", ".venv/ready", "demo", "BIN=."]

    said = subprocess.run(demo, cwd=tmp_path, capture_output=True, check=True, timeout=300)
    assert b"in the background" in said.stdout
    (tmp_path / "go-on").write_text("made")  # waits for one that reads
    said = subprocess.run(demo, cwd=tmp_path, capture_output=True, check=True, timeout=300)
    assert b"in the background" not in said.stdout

    lines = (tmp_path / "calls").read_text().splitlines()
    mine = os.nice(0)
    run, warm = f"{mine} run src/mesokit/method/mpcd/templates/poiseuille.toml", "19 warm --all"
    assert [line for line in lines if " -c" not in line] == [run, warm, run]
