"""Peak memory for each particle, on one rank and on several, of a whole run with its checkpoint.

    python -m benchmarks.rank_memory [--side 128] [--ranks 1 2 4]

What a process holds with next to no particles (Python, its libraries, compiled kernels) is taken
off: it does not grow with the fluid.
"""

from __future__ import annotations

import argparse
import json
import resource
import tempfile
from pathlib import Path

from benchmarks import ranks as ranks_of
from mesokit import Box, Fluid, Run, Simulation

SMALL, DENSITY, STEPS = 16, 10, 20


def one(side: int) -> None:
    """One run; rank 0 prints the peaks of all ranks in bytes."""
    from mpi4py import MPI

    comm = MPI.COMM_WORLD
    folder = comm.bcast(tempfile.mkdtemp() if comm.rank == 0 else None)
    simulation = Simulation(
        run=Run(steps=STEPS), box=Box([side] * 3), fluid=Fluid(density=DENSITY),
        output=Path(folder) / "run", threads=1,
    )  # fmt: skip
    simulation.run(progress=False)
    peaks = comm.gather(1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    if comm.rank == 0:
        print(json.dumps(peaks))


def peaks(ranks: int, side: int) -> list[int]:
    """Of all ranks, in bytes."""
    found: list[int] = ranks_of.said("benchmarks.rank_memory", ranks, "--one", side)
    return found


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--one", type=int)
    parser.add_argument("--side", type=int, default=128)
    parser.add_argument("--ranks", type=int, nargs="*", default=[1, 2, 4])
    given = parser.parse_args()
    if given.one:
        one(given.one)
    else:
        particles = DENSITY * given.side**3
        print(f"{given.side}^3 cells, {particles} particles\n")
        print("| ranks | MB of a rank with nobody | with its share (most) | bytes a particle |")
        print("|---|---|---|---|")
        for ranks in given.ranks:
            bare, full = peaks(ranks, SMALL), peaks(ranks, given.side)
            each = (sum(full) - sum(bare)) / particles
            print(f"| {ranks} | {max(bare) / 1e6:.0f} | {max(full) / 1e6:.0f} | {each:.1f} |")
