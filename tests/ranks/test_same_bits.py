"""The bits of a run do not depend on ranks, threads, and where borders are."""

import subprocess
import sys
from pathlib import Path

import pytest
from rank_runs import MPIEXEC

HERE = Path(__file__).parent


def differing(program, ranks, *arguments):
    """What a program on so many ranks says that is not as on one process."""
    command = [MPIEXEC, "-n", str(ranks), sys.executable, "-m", "mpi4py", HERE / program]
    command += map(str, arguments)
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    different, compared = done.stdout.splitlines()[-2:]
    assert compared.startswith("compared ")
    return different


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "ranks", "threads"),
    [("channel", 3, 1), ("sheared dimers", 4, 1), ("long flights", 2, 2)],
)
def test_ranks_have_the_bits_of_one_process(name, ranks, threads):
    assert not differing("same_bits.py", ranks, name, threads)


@pytest.mark.long
@pytest.mark.parametrize("ranks", [1, 2, 3])
@pytest.mark.parametrize("name", ["past a post", "past a sphere", "two species", "molecules"])
def test_observables_add_up_the_same_bits(name, ranks):
    """Pieces of few particles on ranks, and all in one piece on one process."""
    assert not differing("same_sums.py", ranks, name)
