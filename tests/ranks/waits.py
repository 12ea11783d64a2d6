"""Two ranks on one core: rank 0 waits for the other, which says how often it has slept meanwhile.

mpiexec -n 2 python -m mpi4py waits.py
"""

import os
import time
from pathlib import Path

from mpi4py import MPI

from mesokit import Box, Case, Fluid, Run
from mesokit.method.mpcd.engine.domains.engine import Ranks
from mesokit.method.mpcd.start.fluid import start
from mesokit.processes.several import wait

COMM = MPI.COMM_WORLD
OFTEN, PATIENCE = 100, 60.0  # sleeps that are enough; seconds for them, on a busy machine


def sleeps(process):
    """How often a process has given its core away to sleep."""
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    [line] = [line for line in lines if line.startswith("voluntary_ctxt_switches")]
    return int(line.split()[1])


def main():
    """Rank 1 begins its step when rank 0 has slept often, or in the end without that."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    engine = Ranks(Case(run=Run(steps=20), box=Box([12, 10]), fluid=Fluid(density=5)), 1, (), COMM)
    start(engine)
    engine.advance(2)
    first = COMM.bcast(os.getpid())
    wait(COMM.Ibarrier())
    if COMM.rank == 1:
        before, last = sleeps(first), time.monotonic() + PATIENCE
        while (slept := sleeps(first) - before) < OFTEN and time.monotonic() < last:
            time.sleep(0.01)
        print(slept >= OFTEN)
    engine.advance(1)


if __name__ == "__main__":
    main()
