"""No rank holds all particles: starts and files are made in parts, to the same bits."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("mpi4py")
MPIEXEC = shutil.which("mpiexec", path=f"{Path(sys.executable).parent}:{os.environ['PATH']}")
PROGRAM = Path(__file__).with_name("program.py")
SMALL, WHOLE = 50, 2**18  # particles of a piece

pytestmark = pytest.mark.skipif(MPIEXEC is None, reason="no mpiexec")


def do(folder, case, what, ranks, piece=SMALL, *more):
    """What the program does on so many ranks; on one it is a process alone."""
    arguments = [sys.executable, PROGRAM, folder, case, what, str(piece), *more]
    start = [MPIEXEC, "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run([*start, *arguments], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(("case", "ranks"), [("bulk", 3), ("solid", 2), ("dimers", 3)])
def test_files_are_those_of_one_rank_byte_by_byte(case, ranks, tmp_path):
    one, some = tmp_path / "one", tmp_path / "some"
    for folder, number, piece in ((one, 1, WHOLE), (some, ranks, SMALL)):
        folder.mkdir()
        do(folder, case, "carry", number, piece)
    names = sorted(p.relative_to(one) for p in one.rglob("*.npz"))
    assert len(names) == 3
    for name in names:
        assert (one / name).read_bytes() == (some / name).read_bytes(), name
    do(one, case, "go_on", ranks)
    do(some, case, "go_on", 1 if case == "dimers" else 2)
    assert (one / "checkpoint.npz").read_bytes() == (some / "checkpoint.npz").read_bytes()


def test_memory_of_a_rank_is_that_of_its_share(tmp_path):
    do(tmp_path, "large", "weigh", 1, 2**14, "ranks")
    one = np.loadtxt(tmp_path / "bytes")
    do(tmp_path, "large", "weigh", 4, 2**14)
    assert np.loadtxt(tmp_path / "bytes") < 0.25 * 1.2 * one
