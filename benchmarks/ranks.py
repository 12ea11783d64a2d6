"""Ranks: two of one thread beside one of two, and what is sent as their number grows.

    python -m benchmarks.ranks            (tables for docs/benchmark.md)
    mpiexec -n 2 python -m benchmarks.ranks --one W2 --threads 1 --steps 100

The second form is one timed run; rank 0 prints a JSON line.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks import lammps_peer

WAYS = {"1 x 1": (1, 1), "1 x 2": (1, 2), "2 x 1": (2, 1)}  # ranks, threads of each
CASES = {
    "W1": "3D periodic 30^3",
    "W2": "3D periodic 64^3",
    "W2@128": "3D periodic 128^3",
    "W3": "3D slit 30^3, force",
    "W4": "2D periodic 160^2",
    "W5-disks": "2D channel 400 x 50 with disks",
    "B-dimers-5": "dimers 30^3, 5 sub-steps",
    "D-2-fill": "8 spheres of R = 4 that move, 35^3",
    "D-3-fill": "27 of them, 33^3",
    "C-5000-10": "5,000 beads in a fluid of 40^3, 10 sub-steps",
}
LEAST_STEPS = 100


def run(name: str, ranks: int, threads: int, steps: int) -> dict[str, Any]:
    """One timed run in processes of its own."""
    words = "--one", name, "--threads", threads, "--steps", steps
    found: dict[str, Any] = said("benchmarks.ranks", ranks, *words)
    return found


def said(module: str, ranks: int, *words: Any) -> Any:
    """What a module says in JSON on its last line, run by so many ranks. Raises RuntimeError."""
    mpiexec = Path(sys.executable).with_name("mpiexec")
    command = [str(mpiexec), "-n", str(ranks), sys.executable, "-m", module, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:])
    return json.loads(done.stdout.strip().splitlines()[-1])


def one(name: str, threads: int, steps: int) -> dict[str, Any] | None:
    """Time so many steps on all ranks together; the answer is rank 0's."""
    from mpi4py import MPI

    from benchmarks.workloads import case
    from mesokit.method.mpcd.engine.cpu.engine import CPU
    from mesokit.method.mpcd.engine.domains.engine import Ranks
    from mesokit.method.mpcd.start.fluid import start

    comm = MPI.COMM_WORLD
    engine = Ranks(case(name), threads, [], comm) if comm.size > 1 else CPU(case(name), threads)
    start(engine)
    engine.advance(engine.numbers.sort_every + 1)
    shared = engine.memory.fluid.cells.shared
    meter = np.array(shared.meter) if comm.size > 1 else np.zeros(8)
    before = engine.seconds
    comm.Barrier()
    began = MPI.Wtime()
    engine.advance(steps)
    comm.Barrier()
    spent = MPI.Wtime() - began
    stages = {key: value - before[key] for key, value in engine.seconds.items()}
    if comm.size > 1:
        meter = np.array(engine.memory.fluid.cells.shared.meter) - meter
    all_stages, meters = comm.gather(stages), comm.gather(meter.tolist())
    bytes_held = comm.gather(engine.memory.bytes_held)
    count = engine.totals()[0]
    if comm.rank:
        return None
    return {
        "name": name, "ranks": comm.size, "threads": threads, "steps": steps, "particles": count,
        "nanoseconds": 1e9 * spent / steps / count, "stages": all_stages, "meters": meters,
        "bytes": bytes_held,
    }  # fmt: skip


def speed(rounds: int, seconds: float, names: Sequence[str] = tuple(CASES)) -> Iterator[str]:
    """Ranks, threads and the peer on as many ranks, in turn."""
    lammps_peer.install()
    yield "## Ranks"
    yield ""
    yield "Nanoseconds per particle-step, ranks x threads in turn; ratios are medians of rounds."
    yield f"The peer is LAMMPS {lammps_peer.version()} on 2 ranks."
    yield ""
    yield (
        "| case | " + " | ".join(WAYS) + " | 2 x 1 over 1 x 1 | least, most | 2 x 1 over 1 x 2 "
        "| least, most | over the peer | least, most |"
    )
    yield "|---|" + "---|" * (len(WAYS) + 6)
    for name in names:
        first = run(name, 1, 1, LEAST_STEPS)
        for ways in list(WAYS.values())[1:]:
            run(name, *ways, LEAST_STEPS)  # compiles
        pace = first["nanoseconds"] * first["particles"] * 1e-9
        steps = max(LEAST_STEPS, int(seconds / pace / 100) * 100)
        rows, theirs = [], []
        for _ in range(rounds):
            rows.append([run(name, *ways, steps)["nanoseconds"] for ways in WAYS.values()])
            if name in lammps_peer.WORKLOADS:
                theirs.append(1e9 / lammps_peer.measure(name, 2, seconds))
        middle = [median(column) for column in zip(*rows, strict=True)]
        one, two = ([row[i] / row[2] for row in rows] for i in range(2))
        peer = [a / row[2] for a, row in zip(theirs, rows, strict=False)]
        yield (
            f"| {name} {CASES[name]} | "
            + " | ".join([f"{x:.2f}" for x in middle] + [_spread(x) for x in (one, two, peer)])
            + " |"
        )


def _spread(ratios: list[float]) -> str:
    """Median, and least and most, as two columns."""
    if not ratios:
        return " | "
    return f"{median(ratios):.2f} | {min(ratios):.2f}, {max(ratios):.2f}"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--one")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--steps", type=int, default=LEAST_STEPS)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--cases", nargs="*", default=list(CASES))
    given = parser.parse_args()
    if given.one:
        answer = one(given.one, given.threads, given.steps)
        if answer:
            print(json.dumps(answer))
    else:
        for line in speed(given.rounds, given.seconds, given.cases):
            print(line, flush=True)
