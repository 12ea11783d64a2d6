"""Kinetic Monte Carlo: time of an event, beside kmcos.

    python -m benchmarks.kinetic_monte_carlo MODEL SIDE [--select S] [--wall]
        [--sublattices] [--threads N]

prints nanoseconds for an event at each line that it reads: of CPU time, or of wall time.

The peer has an environment of its own, with a compiler of Fortran (gfortran):

    python3.11 -m venv ENV
    ENV/bin/pip install kmcos "numpy==1.23.5" "setuptools<70" ase lxml
    KMCOS=ENV/bin/python python -m benchmarks --only kinetic-monte-carlo

Without KMCOS its column is empty.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from statistics import median
from typing import Any

from benchmarks import worker
from benchmarks.worker import ROOT, Worker
from mesokit import Box, Run, Simulation
from mesokit.method.kinetic_monte_carlo.model.ising import Ising
from mesokit.method.kinetic_monte_carlo.model.lattice_gas import GasProcess, LatticeGas
from mesokit.method.kinetic_monte_carlo.section import Lattice, Sublattices

PEER = ROOT / "build" / "kmcos"  # the compiled model
GAS = LatticeGas(
    process=(
        GasProcess(name="adsorb", site="empty -> A", rate=1.0),
        GasProcess(name="desorb", site="A -> empty", rate=1.0),
        GasProcess(name="hop", site="A -> empty", neighbour="empty -> A", rate=1.0),
    )
)
MODELS = {"gas": (GAS, 2.0), "ising": (Ising(kT=3.0), 0.46)}  # and events of a site and time
EVENTS = 500_000  # between two looks at the clock
SETTLED = 4.0  # time before the first, for spins to be near equilibrium
SIZES = (64, 128, 256, 512, 1024, 2048, 4096)
BESIDE = (("gas", 20, "auto", 5.0), ("gas", 128, "auto", 5.0), ("ising", 128, "classes", 6.7))
TWO = 1.7  # of two threads over one, asked for


def work(model: str, side: int, select: Any, sublattices: bool, threads: int, wall: bool) -> None:
    """Time events, a line for each line that is read."""
    rules, often = MODELS[model]
    slice_of_time = EVENTS * threads / (side * side * often)
    lattice = Lattice(
        model=rules, timestep=slice_of_time, select=select,
        sublattices=Sublattices() if sublattices else None,
    )  # fmt: skip
    engine: Any = Simulation(
        run=Run(steps=0, method="kinetic-monte-carlo"), box=Box([side, side]), lattice=lattice,
        threads=threads,
    ).engine  # fmt: skip
    engine.advance(max(2, round(SETTLED / slice_of_time)))
    clock = time.perf_counter if wall else time.process_time
    print("ready", flush=True)
    for _ in sys.stdin:
        before, began = int(engine.happened().sum()), clock()
        engine.advance(1)
        took = clock() - began
        print(1e9 * took / (int(engine.happened().sum()) - before), flush=True)


def ours(model: str, side: int, *more: str) -> Worker:
    """mesokit."""
    module = "benchmarks.kinetic_monte_carlo"
    return Worker([sys.executable, "-m", module, model, str(side), *more])


def peer(side: int) -> Worker | None:
    """kmcos with the lattice gas, None where it is not installed."""
    if not (python := os.environ.get("KMCOS")):
        return None
    scripts = ROOT / "benchmarks" / "kmcos"
    if not (PEER / "out").exists():
        build = [python, str(scripts / "model.py"), str(PEER)]
        subprocess.run(build, check=True, capture_output=True)
    return Worker([python, str(scripts / "worker.py"), str(PEER), str(side)])


def in_turn(workers: Sequence[Worker | None], rounds: int) -> list[list[float]]:
    """Nanoseconds of an event of each, a list for a round; nan of one that is not there."""
    return [[one[0] for one in each] for each in worker.in_turn(workers, rounds)]


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Beside kmcos, by size, and on two threads."""
    rounds = max(rounds, 3)
    looks = max(rounds, round(seconds * rounds))  # each of a fraction of a second
    yield "## Kinetic Monte Carlo"
    yield ""
    yield (
        "Million events per second of a core; CPU time, medians of alternating looks, ratios of "
        "neighbouring ones. Gas: particles adsorb, desorb and hop, all rates 1 (kmcos runs the "
        "same). Ising: kT = 3 J, Metropolis, by classes, beside the gas of kmcos on as many sites."
    )
    yield ""
    yield "| model | sites | chosen by | mesokit | kmcos | ratio | quartiles | asked for |"
    yield "|---|---|---|---|---|---|---|---|"
    for model, side, select, asked in BESIDE:
        workers = [ours(model, side, "--select", select), peer(side)]
        found = in_turn(workers, looks)
        one, other = (1e3 / median(each[k] for each in found) for k in range(2))
        ratios = sorted(each[1] / each[0] for each in found)
        low, high = ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]
        beside = "| | |"
        if other == other:
            beside = f"{other:.2f} | {median(ratios):.1f} | {low:.1f} to {high:.1f} |"
        yield f"| {model} | {side}^2 | {select} | {one:.1f} | {beside} {asked:g} |"
    yield ""
    yield "Nanoseconds for an event by size, in turn with the smallest."
    yield ""
    yield "| sites | gas | over 64^2 | Ising, by classes | over 64^2 |"
    yield "|---|---|---|---|---|"
    kinds = (("gas", "auto"), ("ising", "classes"))
    for side in SIZES:
        cells = []
        for model, select in kinds:
            pair = [ours(model, one, "--select", select) for one in (side, SIZES[0])]
            found = in_turn(pair, rounds)
            ratio = median(large / small for large, small in found)
            cells.append(f"{median(large for large, _ in found):.0f} | {ratio:.2f}")
        yield f"| {side}^2 | {' | '.join(cells)} |"
    yield ""
    yield f"Two threads over one on sublattices of 1024^2, wall time ({TWO:g} asked for):"
    yield ""
    yield "| model | one thread | two threads | over one | exact, one thread |"
    yield "|---|---|---|---|---|"
    for model, select in kinds:
        workers = [
            ours(model, 1024, "--wall", "--select", select, "--sublattices", "--threads", "1"),
            ours(model, 1024, "--wall", "--select", select, "--sublattices", "--threads", "2"),
            ours(model, 1024, "--wall", "--select", select),
        ]
        found = in_turn(workers, looks)
        one, two, exact = (1e3 / median(each[k] for each in found) for k in range(3))
        ratio = median(first / second for first, second, _ in found)
        yield f"| {model} | {one:.1f} | {two:.1f} | {ratio:.2f} | {exact:.1f} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("model", choices=MODELS)
    parser.add_argument("side", type=int)
    parser.add_argument("--select", default="auto")
    parser.add_argument("--sublattices", action="store_true")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--wall", action="store_true")
    work(**vars(parser.parse_args()))


if __name__ == "__main__":
    main()
