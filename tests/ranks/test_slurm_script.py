"""The script for Slurm, with a stand-in for `srun`."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "examples" / "ranks.sbatch"
SRUN = """#!/bin/sh
echo "$@" >> {folder}/told
[ "$1" = --cpu-bind=cores ] && [ "$2" = mesokit ] && shift 2
exec {python} -m mesokit "$@"
"""
CASE = "[run]\nsteps = 20\n[box]\nsize = [12, 10]\n[fluid]\ndensity = 5\n"


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
def test_it_starts_a_run_and_goes_on_with_it(tmp_path):
    (tmp_path / "bin").mkdir()
    srun = tmp_path / "bin" / "srun"
    srun.write_text(SRUN.format(folder=tmp_path, python=sys.executable))
    srun.chmod(0o755)
    (tmp_path / "case.toml").write_text(CASE)
    path = f"{srun.parent}{os.pathsep}{os.environ['PATH']}"
    environ = os.environ | {"PATH": path, "SLURM_CPUS_PER_TASK": "2"}
    for _ in range(2):
        command = ["bash", SCRIPT, "case.toml", "out"]
        done = subprocess.run(command, cwd=tmp_path, env=environ, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
    first, second = (tmp_path / "told").read_text().splitlines()
    assert first == "--cpu-bind=cores mesokit run case.toml --output out --threads 2 --quiet"
    assert second == "--cpu-bind=cores mesokit resume out --threads 2 --quiet"
    assert (tmp_path / "out" / "run.h5").exists()


def test_it_says_how_it_is_used(tmp_path):
    done = subprocess.run(["bash", SCRIPT], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode != 0
    assert "usage: sbatch ranks.sbatch CASE.toml OUTPUT" in done.stderr
