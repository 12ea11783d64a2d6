"""The ranks of tests/ranks/test_parts.py: runs begun and continued on ranks and on one process.

mpiexec -n 4 python -m mpi4py program.py FOLDER carry
"""

from __future__ import annotations

import shutil
import sys
import tracemalloc
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from mpi4py import MPI

from mesokit import Box, Case, Disk, Fluid, Harmonic, Plates, Run, Trajectory
from mesokit.io import measured
from mesokit.io.run_directory import RunDirectory
from mesokit.io.trajectory import TrajectoryWriter
from mesokit.method.mpcd.engine import pieces
from mesokit.method.mpcd.engine.cpu.engine import CPU
from mesokit.method.mpcd.engine.domains.engine import Ranks
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start.fluid import start
from mesokit.processes.several import wait

COMM = MPI.COMM_WORLD
SMALL, MIDDLE, WHOLE = 50, 2**14, 2**18  # particles of a piece
FRAMES = Trajectory(every=2, fields=("position", "velocity", "image", "id"))
DISK = Disk(centre=[5.3, 6.1], radius=2.5)
RUN, SIZE = Run(steps=20), Box([14, 12])
CASES = {
    "bulk": Case(run=RUN, box=SIZE, fluid=Fluid(density=5)),
    "solid": Case(run=RUN, box=SIZE, fluid=Fluid(density=5), walls=[Plates("y"), DISK]),
    "dimers": Case(
        run=RUN, box=SIZE, fluid=Fluid(density=5, molecule=Molecule(bond=Harmonic(K=3.0)))
    ),
}
LARGE = Case(run=RUN, box=Box([400, 400]), fluid=Fluid(density=5))


def engine_of(case, comm):
    """An engine on the ranks of a communicator, or on this process alone."""
    return CPU(case, 1) if comm is None else Ranks(case, 1, (), comm)


def kept(engine, folder, case, root):
    """A checkpoint of an engine."""
    replica = SimpleNamespace(engine=engine, accumulators={})
    measured.keep(folder, case, {"step": engine.step, "looked": False}, [replica], root)
    return replica


def carry(case, folder, comm, piece):
    """Start, write, go on with frames, write again: all that a run leaves in its folder."""
    pieces.PIECE, root = piece, comm is None or comm.rank == 0
    engine = engine_of(case, comm)
    start(engine)
    directory = RunDirectory(folder)
    kept(engine, directory, case, root)
    if root:
        directory.checkpoint_file.rename(folder / "start.npz")
    writer = TrajectoryWriter(FRAMES, folder / "frames", case.particles, here=root)
    for _ in range(3):
        engine.advance(2)
        writer.record(engine)
    writer.flush()
    kept(engine, directory, case, root)
    if root:
        shutil.copy(directory.checkpoint_file, folder / "carried.npz")


def go_on(case, folder, comm):
    """From the checkpoint some steps further."""
    pieces.PIECE = SMALL
    engine = engine_of(case, comm)
    replica = SimpleNamespace(engine=engine, accumulators={})
    directory = RunDirectory(folder)
    meta = measured.take_up(directory, case, [replica], comm)
    assert meta["step"] == engine.step == 6
    engine.advance(5)
    kept(engine, directory, case, comm is None or comm.rank == 0)


def weigh(folder, comm):
    """The most memory that a rank has at once, in bytes for each particle of the box."""
    pieces.PIECE, root = MIDDLE, comm.rank == 0
    tracemalloc.start()
    engine = engine_of(LARGE, comm)
    start(engine)
    directory = RunDirectory(folder)
    replica = kept(engine, directory, LARGE, root)
    measured.take_up(directory, LARGE, [replica], comm)
    most = comm.allreduce(tracemalloc.get_traced_memory()[1], MPI.MAX)
    tracemalloc.stop()
    if root:
        np.savetxt(folder / f"bytes-{comm.size}", [most / LARGE.particles])


def main(folder, does):
    """What one process does here, rank 0 does while the others sleep."""
    root = COMM.rank == 0
    for name, case in CASES.items():
        one, some = folder / f"{name}-one", folder / f"{name}-some"
        if does == "carry":
            if root:
                one.mkdir()
                some.mkdir()
                carry(case, one, None, WHOLE)
            wait(COMM.Ibarrier())
            carry(case, some, COMM, SMALL)
            go_on(case, one, COMM)
        elif name != "dimers":
            go_on(case, some, COMM)
        elif root:
            go_on(case, some, None)
    if does == "carry":  # all is compiled: machine code is not counted
        weigh(folder, COMM)
        if root:
            weigh(folder, MPI.COMM_SELF)
    wait(COMM.Ibarrier())


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
