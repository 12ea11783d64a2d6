"""The workloads of the speed comparison, as cases; and one timed run of one of them.

    python -m benchmarks.workloads W1 --threads 2 --seconds 3

prints one JSON line: particle-steps per second, nanoseconds per particle-step of each stage, bytes.
"""

from __future__ import annotations

import argparse
import json
import math
import resource
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from mesokit import (
    AT,
    FENE,
    SRD,
    WCA,
    ATPlusA,
    Box,
    Case,
    Disk,
    Fluid,
    MaxwellBoltzmann,
    NoForce,
    NoThermostat,
    Plates,
    Polymer,
    Run,
    Sampled,
    Simulation,
    Solids,
    Solutes,
    SRDPlusA,
    Uniform,
)

RULES = {"at": AT(), "srd+a": SRDPlusA(angle=130), "at+a": ATPlusA()}
STEPS = 10**9  # the clock ends a run


def case(name: str) -> Case:
    """W1 to W4, with -thermostat or the name of a rule, such as -at, in place of plain SRD.

    W1@48 is W1 with another length of the box. W5 is a 2D fluid of 400 x 50 cells with a
    thermostat: empty, or a channel with -plates, with -disks that cover 10 % of the area as well,
    or with these -sampled. B-dimers-5 and B-decamers-5 are fluids of molecules, by 5 sub-steps,
    S-1000-10 a thousand beads of solutes alone by 10, C-5000-10 5,000 of them in a fluid. D-3-fill
    has 3^3 spheres that move, with virtual particles.
    """
    if name.startswith("B-"):
        from benchmarks import bonded

        _, kind, substeps = name.split("-")
        return Case(
            run=Run(steps=STEPS),
            box=Box([bonded.LENGTH] * 3),
            fluid=Fluid(
                density=bonded.DENSITY,
                collision=SRD(angle=130),
                molecule=bonded.molecule(kind, int(substeps)),
            ),
        )
    if name.startswith("S-"):
        from benchmarks import solutes

        _, beads, substeps = name.split("-")
        return Case(
            run=Run(steps=STEPS),
            box=Box([solutes.box(int(beads))] * 3),
            fluid=Fluid(density=10, timestep=solutes.TIMESTEP),
            solutes=solutes.solutes(int(beads), int(substeps)),
        )
    if name.startswith("C-"):
        _, beads, substeps = name.split("-")
        return _chains(int(beads), int(substeps))
    if name.startswith("D-"):
        from benchmarks import bodies

        _, along, virtual = name.split("-")
        return bodies.case(int(along), virtual)
    if name.startswith("W5"):
        return _channel(name.partition("-")[2])
    workload, _, variant = name.partition("-")
    workload, _, length = workload.partition("@")
    size = {"W1": [30] * 3, "W2": [64] * 3, "W3": [30] * 3, "W4": [160] * 2}[workload]
    size = [int(length)] * len(size) if length else size
    wall = workload == "W3"
    return Case(
        run=Run(steps=STEPS),
        box=Box(size),
        fluid=Fluid(
            density=10,
            timestep=0.1,
            collision=RULES.get(variant, SRD(angle=130)),
            thermostat=MaxwellBoltzmann() if variant == "thermostat" else NoThermostat(),
            force=Uniform([0.01, 0, 0]) if wall else NoForce(),
        ),
        walls=[Plates("z")] if wall else [],
    )


def _chains(beads: int, substeps: int) -> Case:
    """Chains in a fluid of particles."""
    return Case(
        run=Run(steps=STEPS),
        box=Box([40] * 3),
        fluid=Fluid(density=10, timestep=0.1, collision=SRD(angle=130)),
        solutes=Solutes(
            (Polymer(beads // 20, 20),), bond=FENE(), pair=WCA(), mass=10.0, substeps=substeps
        ),
    )


def _channel(solids: str) -> Case:
    box = Box([400, 50])
    radius = (0.1 * box.volume / (6 * math.pi)) ** 0.5
    centres = [((i + 0.5) * 400 / 6, 25.0) for i in range(6)]
    disks: list[Any] = [Disk(centre=centre, radius=radius) for centre in centres]
    if solids == "sampled":
        disks = [_sampled(Solids(disks, box))]
    return Case(
        run=Run(steps=STEPS),
        box=box,
        fluid=Fluid(
            thermostat=MaxwellBoltzmann(),
            force=Uniform([0.0002, 0]) if solids else NoForce(),
        ),
        walls=[Plates("y"), *(disks if solids != "plates" else [])] if solids else [],
    )


def _sampled(solids: Solids, spacing: float = 0.25) -> Sampled:
    """The same solids as a signed distance on a grid."""
    grids = [np.arange(0, length, spacing) for length in solids.size]
    points = np.stack(np.meshgrid(*grids, indexing="ij"), -1)
    values = solids.distance(points).reshape(points.shape[:-1])
    file = Path(tempfile.mkdtemp()) / "disks.npy"
    return Sampled.from_array(values, file, spacing=spacing)


def measure(name: str, threads: int, seconds: float, warm: int = 101) -> dict[str, object]:
    """Run for about so many seconds; the warm-up takes compiling and the first sorts out of it."""
    simulation = Simulation(case(name), threads=threads)
    fluid = simulation.engine
    fluid.advance(warm)
    start, before, chunk = time.perf_counter(), dict(fluid.seconds), 2 * fluid.numbers.sort_every
    first = fluid.step
    while fluid.step == first or time.perf_counter() - start < seconds:
        fluid.advance(chunk)
    elapsed = time.perf_counter() - start
    work = (fluid.step - first) * fluid.totals()[0]
    stages = {stage: 1e9 * (s - before[stage]) / work for stage, s in fluid.seconds.items()}
    return {
        "workload": name,
        "threads": threads,
        "particles": fluid.n,
        "rate": work / elapsed,
        "nanoseconds": 1e9 * elapsed / work,
        "stages": stages,
        "bytes_per_particle": fluid.memory.bytes_held / fluid.totals()[0],
        "peak_kilobytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("workload")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3.0)
    given = parser.parse_args()
    print(json.dumps(measure(given.workload, given.threads, given.seconds)))
