"""Event-driven dynamics: collisions per second, beside a Lennard-Jones liquid in LAMMPS.

    python -m benchmarks.event_driven 3 0.49 4000 --seconds 3

prints collisions per second of hard spheres: dimension, packing fraction, number.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import NamedTuple

from benchmarks import lammps_peer
from mesokit import Box, Case, HardSpheres, Run, Simulation
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.method.spheres.hard.engine import system
from mesokit.run.schedule import Leg

ATOMS = 32_000  # of LAMMPS
STEPS = 20  # at a time, so that calls from Python do not count
SETTLED = 20  # collisions of each sphere before the clock starts


class Gas(NamedTuple):
    """Dimension, packing fraction and number of spheres."""

    dimension: int
    fraction: float
    number: int

    @property
    def name(self) -> str:
        """As in the table."""
        return f"{self.dimension}D, packing fraction {self.fraction:g}, {self.number:,}".replace(
            ",000", " 000"
        )


ASKED = {
    Gas(3, 0.49, 4_000): "0.45",
    Gas(3, 0.49, 32_000): "0.25",
    Gas(3, 0.30, 4_000): "",
    Gas(2, 0.50, 4_000): "",
    Gas(2, 0.50, 32_000): "",
}
SIZES = (1_000, 10_000, 100_000, 1_000_000)


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Collisions per second, and for each step of an atom in LAMMPS."""
    lammps_peer.install()
    yield "## Event-driven dynamics"
    yield ""
    yield (
        "Million collisions per second of a core, and for each step of an atom in LAMMPS "
        f"{lammps_peer.version()} (`lj/cut` 2.5, {ATOMS:,} atoms, one rank) run in turn; "
        "CPU time, medians, the ratios pair by pair."
    )
    yield ""
    yield (
        "| spheres | collisions | LAMMPS | ratio | smallest | largest | asked for |\n"
        "|---|---|---|---|---|---|---|"
    )
    for gas, asked in ASKED.items():
        once(gas, 0.0)  # compiles
        pairs = [(once(gas, seconds), atom_steps(seconds)) for _ in range(rounds)]
        ratios = sorted(a / b for a, b in pairs)
        ours, theirs = (median(side) / 1e6 for side in zip(*pairs, strict=True))
        yield (
            f"| {gas.name} | {ours:.2f} | {theirs:.2f} | {median(ratios):.2f} | {ratios[0]:.2f} | "
            f"{ratios[-1]:.2f} | {asked} |"
        )
    yield ""
    gains = sorted(replicas(seconds) for _ in range(rounds))
    yield (
        f"Two replicas on two threads do {median(gains):.2f} ({gains[0]:.2f} to {gains[-1]:.2f}) "
        "times the collisions of one on one thread (4,000 spheres, packing fraction 0.49)."
    )
    yield ""
    yield (
        "Nanoseconds per collision by number of spheres, 3D, packing fraction 0.3: with the "
        "calendar, and with bins so wide that all events are in one heap."
    )
    yield ""
    yield "| spheres | calendar | one heap |\n|---|---|---|"
    for number in SIZES:
        both = (once(Gas(3, 0.30, number), seconds, *how) for how in ((), ("--heap",)))
        yield f"| {number} | {' | '.join(f'{1e9 / rate:.0f}' for rate in both)} |"


def once(gas: Gas, seconds: float, *how: str) -> float:
    """Collisions per second of one run, in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.event_driven", *map(str, gas), *how]
    command += ["--seconds", str(seconds)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def measure(gas: Gas, seconds: float) -> float:
    """Run for about so many seconds, once the lattice of the start has gone."""
    volume = gas.number * ball_volume(gas.dimension, 1.0) / gas.fraction
    size = [volume ** (1 / gas.dimension)] * gas.dimension
    case = Case(
        run=Run(0, method="event-driven"),
        box=Box(size),
        spheres=HardSpheres(number=gas.number, timestep=0.02),
    )
    engine = Simulation(case).engine
    engine.advance(1)
    if seconds == 0.0:
        return 0.0
    while engine.collisions[0] < SETTLED * gas.number / 2:
        engine.advance(STEPS)
    engine.end_warmup()
    start = time.process_time()
    while (took := time.process_time() - start) < seconds:
        engine.advance(STEPS)
    return engine.collisions[0] / took


def replicas(seconds: float) -> float:
    """Collisions per second of two replicas on two threads over those of one on one, in turn."""
    gas, engines = Gas(3, 0.49, 4_000), {}
    way = [Leg(STEPS, False, False, ())] * 10  # as long as a run goes on before it looks up
    for number in (1, 2):
        case = Case(
            run=Run(0, method="event-driven", replicas=number),
            box=Box([(gas.number * ball_volume(3, 1.0) / gas.fraction) ** (1 / 3)] * 3),
            spheres=HardSpheres(number=gas.number, timestep=0.02),
        )
        engines[number] = Simulation(case, threads=number).replicas
        engines[number].go(way)
    took = {1: 0.0, 2: 0.0}
    while took[1] < seconds:
        for number, copies in engines.items():
            began = time.perf_counter()
            copies.go(way)
            took[number] += time.perf_counter() - began
    return 2 * took[1] / took[2]


def atom_steps(seconds: float) -> float:
    """Steps of atoms per second of LAMMPS, from a run of about so many seconds."""
    steps = max(40, int(seconds * 2e6 / ATOMS))
    folder = Path(sys.executable).parent
    command = [str(folder / "mpiexec"), "-n", "1", str(folder / "lmp"), "-in", "in.lammps_lj"]
    command += ["-var", "steps", str(steps), "-log", "none"]
    done = subprocess.run(
        command,
        cwd=lammps_peer.INPUTS,
        env=lammps_peer.environment(),
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        raise RuntimeError(f"LAMMPS failed: {done.stdout[-500:]} {done.stderr[-500:]}")
    took = float(re.findall(r"Loop time of ([\d.e+-]+)", done.stdout)[-1])
    used = float(re.findall(r"([\d.]+)% CPU use", done.stdout)[-1]) / 100
    return ATOMS * steps / (took * used)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("dimension", type=int)
    parser.add_argument("fraction", type=float)
    parser.add_argument("number", type=int)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--heap", action="store_true", help="all events in one heap")
    given = parser.parse_args()
    if given.heap:
        system.PER_BIN = 1e12
    print(measure(Gas(given.dimension, given.fraction, given.number), given.seconds))
