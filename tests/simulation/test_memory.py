"""The memory that `check` estimates is what a run takes at its peak."""

from __future__ import annotations

import subprocess
import sys

import pytest

from mesokit import Case
from mesokit.seam.method import summary_of

resource = pytest.importorskip("resource", reason="the system does not tell peaks of memory")
UNIT = 1 if sys.platform == "darwin" else 1024  # bytes of what it tells
OBSERVED = '[[observe]]\nquantity = "conservation"\nevery = 5\n'
SOLVENT = """
[run]
steps = 10
[box]
size = [SIZE]
[solutes]
solvent = "random"
[[solutes.polymers]]
number = 1
length = 100
bond = { rule = "harmonic", K = 2.0 }
mass = 5.0
"""
FLUID = "[run]\nsteps = 5\n[box]\nsize = [60, 60, 60]\n[fluid]\ndensity = 10\n"
PEAK = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


@pytest.mark.long
@pytest.mark.parametrize(
    "text",
    [
        SOLVENT.replace("SIZE", "200, 200, 200") + OBSERVED,
        SOLVENT.replace("SIZE", "3000, 3000") + OBSERVED,
        FLUID + OBSERVED,
    ],
    ids=["random solvent", "random solvent in 2D", "fluid"],
)
def test_the_estimate_is_near_the_peak(text, tmp_path):
    (tmp_path / "case.toml").write_text(text)
    expected = summary_of(Case.from_toml(tmp_path / "case.toml"), 2).memory
    peak_of_run(tmp_path, "compiling")  # which takes more, and is told apart
    peak = peak_of_run(tmp_path, "compiled")
    assert peak == pytest.approx(expected, rel=0.25)


def peak_of_run(folder, name):
    """Bytes of a run at its peak, which only a process of its own tells."""
    run = [sys.executable, "-m", "mesokit", "run", "case.toml", "--threads", "2", "--quiet"]
    command = [sys.executable, "-c", PEAK, *run, "--output", name]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return UNIT * int(done.stdout.split()[-1])
