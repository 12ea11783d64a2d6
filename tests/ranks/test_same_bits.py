"""The bits of a run do not depend on ranks, threads, and where borders are."""

import subprocess
import sys
from pathlib import Path

import pytest
from rank_runs import MPIEXEC

PROGRAM = Path(__file__).with_name("same_bits.py")


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "ranks", "threads"),
    [("channel", 3, 1), ("sheared dimers", 4, 1), ("long flights", 2, 2)],
)
def test_ranks_have_the_bits_of_one_process(name, ranks, threads):
    command = [MPIEXEC, "-n", str(ranks), sys.executable, "-m", "mpi4py", PROGRAM, name]
    done = subprocess.run([*command, str(threads)], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    different, compared = done.stdout.splitlines()[-2:]
    assert not different
    assert compared.startswith("compared ")
