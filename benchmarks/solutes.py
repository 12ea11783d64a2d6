"""Solutes: chains of Kremer and Grest, beside the same chains in LAMMPS."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median

import numpy as np

from benchmarks import bonded, lammps_peer, once
from mesokit import FENE, WCA, Polymer, Solutes
from mesokit.method.mpcd.start.growth import grown

BEADS, LENGTH, DENSITY = (1_000, 10_000, 100_000), 20, 0.2
SUBSTEPS, TIMESTEP = 20, 0.08


def box(beads: int) -> int:
    """Side of the cubic box."""
    return round((beads / DENSITY) ** (1 / 3))


def solutes(beads: int, substeps: int) -> Solutes:
    """Chains alone: a random solvent costs what beads cost."""
    return Solutes(
        (Polymer(beads // LENGTH, LENGTH),), bond=FENE(), pair=WCA(), substeps=substeps,
        solvent="random",
    )  # fmt: skip


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Nanoseconds per bead-sub-step, ours and theirs, in turn."""
    lammps_peer.install()
    yield "## Solutes"
    yield ""
    yield (
        f"3D, chains of {LENGTH} beads (FENE and WCA), {DENSITY} beads per cell, one thread; "
        f"nanoseconds per bead and sub-step of {TIMESTEP / SUBSTEPS:g}. Ours is a timestep of "
        f"{SUBSTEPS} sub-steps over {SUBSTEPS}, the collision with a random solvent included. "
        "LAMMPS runs the same chains with `fix nve`, and with a Langevin thermostat. Both have a "
        "skin of 0.4."
    )
    yield ""
    yield "| beads | ours | LAMMPS, nve | ratio | LAMMPS, Langevin | ratio |"
    yield "|---|---|---|---|---|---|"
    for beads in BEADS:
        name = f"S-{beads}-{SUBSTEPS}"
        once.run(name, 1, 0.0)
        ours: list[float] = []
        theirs: dict[str, list[float]] = {"nve": [], "langevin": []}
        with tempfile.TemporaryDirectory() as folder:
            data = Path(folder) / "chains.data"
            write_chains(data, beads)
            for _ in range(rounds):
                ours.append(float(once.run(name, 1, seconds)["nanoseconds"]) / SUBSTEPS)
                steps, size = max(20, int(seconds * 1e7 / beads)), TIMESTEP / SUBSTEPS
                for bath, times in theirs.items():
                    took = bonded.loop_time(
                        "in.lammps_solutes", data=data, steps=steps, size=size, bath=bath
                    )
                    times.append(1e9 * took / (beads * steps))
        cells = [f"{beads}", f"{median(ours):.1f}"]
        for times in theirs.values():
            ratio = median(b / a for a, b in zip(ours, times, strict=True))
            cells += [f"{median(times):.1f}", f"{ratio:.2f}"]
        yield "| " + " | ".join(cells) + " |"


def write_chains(path: Path, beads: int) -> None:
    """Chains without overlaps as a LAMMPS data file."""
    side = box(beads)
    size, shape = np.full(3, float(side)), solutes(beads, 20)
    r = grown(shape, 1.0, size, size, 1, lambda places: np.ones(places.shape[:-1], bool))
    bonded.write_data(path, side, r, shape.bonds(), LENGTH, "1 30.0 1.5 1.0 1.0")
