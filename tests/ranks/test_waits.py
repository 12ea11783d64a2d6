"""Ranks that share cores sleep while they wait for others; those with cores of their own do not."""

import platform
from pathlib import Path
from types import SimpleNamespace

import pytest

from mesokit.method.mpcd.engine.domains.messages.mpi import crowded
from mesokit.processes.cores import usable_cores, which_cores
from tests.helpers.rank_runs import on_ranks


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="sleeps are not counted here")
def test_a_rank_sleeps_while_it_waits_for_one_on_its_core():
    assert on_ranks(2, "waits.py") == "True\n"


@pytest.mark.parametrize(
    ("machines", "threads", "expected"),
    [
        ([0], 1, False),
        ([0], 2, True),  # more threads than cores
        ([0, 0], 1, True),
        ([0, 1], 1, False),  # of two machines
    ],
)
def test_ranks_are_crowded_by_threads_on_the_same_cores(machines, threads, expected):
    """The first of these ranks, each with so many threads for each core of its machine."""

    def allgather(own):
        names = platform.node(), "another machine"
        every = [((names[machine], which_cores()), own[1]) for machine in machines]
        assert own == every[0]
        return every

    assert crowded(SimpleNamespace(allgather=allgather), threads * usable_cores()) is expected
