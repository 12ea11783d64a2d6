"""What the ranks of a test do: run under mpiexec with a folder, a case and what to do."""

from __future__ import annotations

import sys
import tracemalloc
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from mpi4py import MPI

from mesokit import Box, Case, Disk, Fluid, Harmonic, Plates, Run, Trajectory
from mesokit.execute import pieces
from mesokit.execute.cpu.engine import CPU
from mesokit.execute.ranks.engine import Ranks
from mesokit.io import measured
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.fluid import start

COMM = MPI.COMM_WORLD
FRAMES = Trajectory(every=2, fields=("position", "velocity", "image", "id"))
DISK = Disk(centre=[5.3, 6.1], radius=2.5)
CASES = {
    "bulk": lambda: Case(run=Run(steps=20), box=Box([12, 10]), fluid=Fluid(density=5)),
    "large": lambda: Case(run=Run(steps=20), box=Box([400, 400]), fluid=Fluid(density=5)),
    "solid": lambda: Case(
        run=Run(steps=20), box=Box([14, 12]), fluid=Fluid(density=5), walls=[Plates("y"), DISK]
    ),
    "dimers": lambda: Case(
        run=Run(steps=20),
        box=Box([12, 10]),
        fluid=Fluid(density=5, molecule=Molecule(bond=Harmonic(K=3.0))),
    ),
}


def engine_of(case, ranks):
    return Ranks(case, 1, (), COMM) if ranks else CPU(case, 1)


def kept(engine, folder, case):
    """A checkpoint of an engine."""
    replica = SimpleNamespace(engine=engine, accumulators={})
    arrays = {f"engine/{name}": v for name, v in engine.state().items()}
    measured.keep(folder, case, {"step": engine.step}, arrays, COMM.rank == 0)
    return replica


def carry(case, folder, ranks):
    """Start, write, go on with frames, write again: all that a run leaves in its folder."""
    engine = engine_of(case, ranks)
    start(engine)
    directory = RunDirectory(folder)
    kept(engine, directory, case)
    if COMM.rank == 0:
        directory.checkpoint_file.rename(folder / "start.npz")
    writer = TrajectoryWriter(FRAMES, folder / "frames", case.particles, here=COMM.rank == 0)
    for _ in range(3):
        engine.advance(2)
        writer.record(engine)
    writer.flush()
    kept(engine, directory, case)


def go_on(case, folder, ranks):
    """From the checkpoint some steps further."""
    engine = engine_of(case, ranks)
    replica = SimpleNamespace(engine=engine, accumulators={})
    directory = RunDirectory(folder)
    meta = measured.take_up(directory, case, [("", replica)], COMM if ranks else None)
    assert meta["step"] == engine.step == 6
    engine.advance(5)
    kept(engine, directory, case)


def weigh(case, folder, ranks):
    """The most memory that a rank has at once, in bytes for each particle of the box."""
    start(engine_of(CASES["bulk"](), ranks))  # compiled before anybody counts
    tracemalloc.start()
    engine = engine_of(case, ranks)
    start(engine)
    directory = RunDirectory(folder)
    replica = kept(engine, directory, case)
    measured.take_up(directory, case, [("", replica)], COMM if ranks else None)
    most = COMM.allreduce(tracemalloc.get_traced_memory()[1], MPI.MAX)
    if COMM.rank == 0:
        np.savetxt(folder / "bytes", [most / case.particles])


if __name__ == "__main__":
    folder, name, does, piece = sys.argv[1:5]
    pieces.PIECE = int(piece)
    ranks = COMM.size > 1 or "ranks" in sys.argv[5:]
    case = CASES[name]()
    {"carry": carry, "go_on": go_on, "weigh": weigh}[does](case, Path(folder), ranks)
