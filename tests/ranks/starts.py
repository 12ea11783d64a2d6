"""A few steps from every source there is, alone or under mpiexec; notes which rows a rank reads.

mpiexec -n 3 python starts.py FOLDER
"""

from __future__ import annotations

import contextlib
import dataclasses
import json
import sys
from pathlib import Path
from unittest import mock

import numpy as np

from mesokit import Box, Case, Fluid, Harmonic, Polymer, Run, Simulation, Solutes, Trajectory
from mesokit.method.mpcd.engine import pieces
from mesokit.method.mpcd.engine.measure.earlier import EarlierRows
from mesokit.method.mpcd.molecule import Molecule
from mesokit.method.mpcd.start import arrays, first_state
from mesokit.method.mpcd.start.section import Start
from mesokit.processes.world import world

FLUIDS = {
    "bulk": Fluid(density=5),
    "dimers": Fluid(density=5, molecule=Molecule(bond=Harmonic(K=3.0))),
}
# by one rank alone, unless rows can be read where they are asked for
SOURCES = {
    ("bulk", "npy"): {"positions": "r.npy", "velocities": "v.npy"},
    ("bulk", "half"): {"positions": "r.npy"},
    ("bulk", "npz"): {"positions": "r.npz", "velocities": "v.npy"},
    ("bulk", "speeds"): {"velocities": "v.npz"},
    ("bulk", "given"): {},
    ("bulk", "run"): {"run": "bulk"},
    ("bulk", "gsd"): {"file": "bulk.gsd"},
    ("dimers", "run"): {"run": "dimers"},
    ("dimers", "gsd"): {"file": "dimers.gsd"},
    ("dimers", "data"): {"file": "dimers.data"},
}
FEW = 50  # particles of a piece
BEADS = {"npy": {"positions": "beads.npy"}, "npz": {"positions": "beads.npz"}}


def make_case(kind, start=None, **parts):
    fluid = FLUIDS[kind]
    if start:
        fluid = dataclasses.replace(fluid, start=Start(**start))
    return Case(run=Run(steps=5), box=Box([12, 10]), fluid=fluid, **parts)


def make_sources(folder):
    """Runs that have come to their end, and what is made of them."""
    import mesokit

    for kind in FLUIDS:
        frames = Trajectory(every=5, fields=("position", "velocity", "image"))
        simulation = Simulation(make_case(kind, trajectory=frames), output=folder / kind, threads=1)
        simulation.run()
        for ending in ("gsd", "data"):
            mesokit.open(folder / kind).export(folder / f"{kind}.{ending}")
        if kind == "bulk":
            for name, rows in (
                ("r", simulation.engine.positions()),
                ("v", simulation.engine.velocities()),
            ):
                np.save(folder / f"{name}.npy", rows)
                np.savez_compressed(folder / f"{name}.npz", rows)
    beads = np.array([[1.0, 1.0], [1.5, 1.5], [4.0, 4.0], [4.5, 4.5]])
    np.save(folder / "beads.npy", beads)
    np.savez(folder / "beads.npz", beads)


class Watched:
    """An array of which it is known which rows were read."""

    state = None  # it stays where it is

    def __init__(self, array, seen):
        self.array, self.seen = array, seen
        self.shape, self.dtype = array.shape, array.dtype

    def __len__(self):
        return len(self.array)

    def __getitem__(self, rows):
        self.seen[rows] = True
        return self.array[rows]


@contextlib.contextmanager
def watched(seen):
    """Meanwhile note which rows are read of files."""
    load, snapshot, earlier = (
        arrays.array_in_file,
        first_state.read_snapshot,
        EarlierRows.__getitem__,
    )

    def read(*given):
        seen[:] = True
        return snapshot(*given)

    def molecules(self, rows):
        first, last, _ = rows.indices(len(self))
        beads = self.numbers.beads
        seen[first // beads * beads : -(-last // beads) * beads] = True
        return earlier(self, rows)

    def loaded(*given):
        found = load(*given)
        if not isinstance(found, np.memmap):
            seen[:] = True
        return Watched(found, seen)

    with contextlib.ExitStack() as changed:
        for where, name, value in (
            (arrays, "array_in_file", loaded),
            (first_state, "read_snapshot", read),
            (EarlierRows, "__getitem__", molecules),
        ):
            changed.enter_context(mock.patch.object(where, name, value))
        yield


@mock.patch.object(pieces, "PIECE", FEW)
@mock.patch.object(arrays, "PIECE", FEW)
def main(folder):
    """Start from all sources; rank 0 notes in a file how many rows each rank has read."""
    here, seen, read = world(), np.zeros(600, bool), {}
    for name, start in BEADS.items():
        polymers = Solutes(
            polymers=(Polymer(number=2, length=2),),
            bond=Harmonic(K=3.0),
            start=Start(**{key: str(folder / file) for key, file in start.items()}),
        )
        state = first_state.first_state(make_case("bulk", solutes=polymers), here=here)
        assert np.array_equal(state.beads, np.load(folder / "beads.npy")), name
    for (kind, name), start in SOURCES.items():
        seen[:] = False
        given = {}
        if name == "given":
            given = {
                "positions": np.load(folder / "r.npy"),
                "velocities": np.load(folder / "v.npy"),
            }
        case = make_case(kind, {key: str(folder / file) for key, file in start.items()})
        with watched(seen):
            simulation = Simulation(case, output=folder / f"{kind}-{name}-{here.size}", **given)
            simulation.engine.advance(5)
            simulation.checkpoint()
        read[f"{kind} {name}"] = here.gathered(int(seen.sum()))
    if here.root:
        (folder / f"read-{here.size}.json").write_text(json.dumps(read))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
