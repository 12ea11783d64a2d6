"""Soft spheres beside LAMMPS: a Lennard-Jones melt and a bed of grains at rest."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks import bonded, lammps_peer
from mesokit import Box, Case, LennardJones, Plates, Run, Simulation, SoftSpheres, SpringDashpot

CELLS, DENSITY, KT = 20, 0.8442, 1.44  # in.lj: 32,000 atoms
BASE, LAYERS = 18, 15
GRAIN_STEP, STIFFNESS, DAMPING = 1e-4, 2e5, 25.0
SETTLING, WARM = 40_000, 100


def melt(threads: int) -> Any:
    """The engine of a melt on a face-centred cubic lattice."""
    side = CELLS * (4 / DENSITY) ** (1 / 3)
    case = Case(
        run=Run(0, method="soft-spheres"),
        box=Box([side] * 3),
        spheres=SoftSpheres(
            number=4 * CELLS**3, kT=KT, pair=LennardJones(), timestep=0.005, skin=0.3
        ),
    )
    return Simulation(case, threads=threads).engine


def bed(threads: int) -> Any:
    """The engine of grains on a floor, not yet at rest."""
    grid = np.stack(np.meshgrid(*map(np.arange, (BASE, BASE, LAYERS)), indexing="ij"), -1)
    places = (grid.reshape(-1, 3) + 0.5) * 1.0
    case = Case(
        run=Run(0, method="soft-spheres"),
        box=Box([BASE, BASE, 2 * LAYERS]),
        walls=[Plates("z")],
        spheres=SoftSpheres(
            number=len(places), kT=0.3, gravity=[0.0, 0.0, -1.0], timestep=GRAIN_STEP,
            pair=SpringDashpot(stiffness=STIFFNESS, damping=DAMPING, friction=0.5),
        ),
    )  # fmt: skip
    return Simulation(case, positions=places, threads=threads).engine


def rate(engine: Any, seconds: float) -> float:
    """Sphere-steps per second, in a run of about so many seconds."""
    began, steps = perf_counter(), 0
    while perf_counter() - began < seconds:
        engine.advance(50)
        steps += 50
    return float(steps * engine.n / (perf_counter() - began))


def write_bed(path: Path, engine: Any) -> None:
    """Grains as a LAMMPS data file."""
    x, v, w = engine.positions(), engine.velocities(), engine.spins()
    lines = ["grains", "", f"{len(x)} atoms", "1 atom types", ""]
    lines += [f"0 {length} {a}lo {a}hi" for a, length in zip("xyz", engine.box, strict=True)]
    lines += ["", "Atoms # sphere", ""]
    lines += [
        f"{i + 1} 1 1.0 {6 / math.pi!r} {' '.join(map(repr, r.tolist()))}" for i, r in enumerate(x)
    ]
    lines += ["", "Velocities", ""]
    both = np.concatenate([v, w], axis=1)
    lines += [f"{i + 1} {' '.join(map(repr, r.tolist()))}" for i, r in enumerate(both)]
    path.write_text("\n".join(lines) + "\n")


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Millions of sphere-steps per second, ours and theirs, in turn."""
    lammps_peer.install()
    yield "## Soft spheres"
    yield ""
    yield (
        f"3D. Melt: LAMMPS' in.lj, {4 * CELLS**3} atoms, cut-off 2.5, skin 0.3, its style "
        f"`lj/cut/opt`. Bed: {BASE * BASE * LAYERS} grains at rest on a floor, spring and dashpot, "
        "friction with history, `gran/hooke/history`. Millions of sphere-steps per second; LAMMPS "
        "on one core."
    )
    yield ""
    yield "| workload | one thread | LAMMPS | ratio | two threads | over one |"
    yield "|---|---|---|---|---|---|"
    engines = {"melt": (melt(1), melt(2))}
    for engine in engines["melt"]:
        engine.advance(WARM)
    settled = bed(2)
    settled.advance(SETTLING)
    alone = bed(1)
    alone.restore(settled.state())
    engines["bed"] = (alone, settled)
    with tempfile.TemporaryDirectory() as folder:
        data = Path(folder) / "bed.data"
        write_bed(data, settled)
        for name, (one, two) in engines.items():
            found: dict[str, list[float]] = {"one": [], "two": [], "theirs": []}
            for _ in range(rounds):
                found["one"].append(rate(one, seconds) / 1e6)
                guess = 2e6 if name == "melt" else 5e6
                steps = max(50, int(seconds * guess / one.n))
                given = {"data": data} if name == "bed" else {}
                took = bonded.loop_time(f"in.lammps_{name}", steps=steps, **given)
                found["theirs"].append(one.n * steps / took / 1e6)
                found["two"].append(rate(two, seconds) / 1e6)
            ratio = median(a / b for a, b in zip(found["one"], found["theirs"], strict=True))
            gain = median(a / b for a, b in zip(found["two"], found["one"], strict=True))
            one_, two_, theirs = (median(found[key]) for key in ("one", "two", "theirs"))
            yield f"| {name} | {one_:.2f} | {theirs:.2f} | {ratio:.2f} | {two_:.2f} | {gain:.2f} |"
