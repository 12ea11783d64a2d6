"""Every example and template, made short, on ranks and threads in any mixture: the same bits.

    mpiexec -n 8 python -m validation.ranks [--ways 1x2 2x1 3x1 4x2 8x1] [--resumed 3x1-2x1] [names]

Each case runs on one process first, then in each of the ways (ranks x threads), with borders that
move whenever work differs; then to its middle in one way and on from there in another. What is
compared: the arrays of the checkpoint, of run.h5 (results and frames) and the log. Rank 0 prints a
line for each case. All is done by the same processes, so that nothing is compiled or loaded twice;
figures, which show these numbers, are not drawn.
"""

from __future__ import annotations

import argparse
import dataclasses
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from mpi4py import MPI

from mesokit import Case, CaseError, MesokitError, Simulation, report
from mesokit.processes import world
from mesokit.processes.alone import Alone
from mesokit.processes.several import Several, wait
from mesokit.run.given import require_ranks

ROOT = Path(__file__).parents[1]
PLACES = "examples/*.toml", "examples/*/*.toml", "src/mesokit/method/mpcd/templates/*.toml"
WAYS = "1x2", "2x1", "3x1", "4x2", "8x1"
RESUMED = ("3x1-2x1",)
ALL = MPI.COMM_WORLD


def cases(names: list[str]) -> Iterator[tuple[str, Path]]:
    """Names and files of all cases of MPCD, or of those asked for."""
    for place in PLACES:
        for path in sorted(ROOT.glob(place)):
            name = f"{path.parent.name}/{path.stem}"
            if names and path.stem not in names:
                continue
            try:
                if Case.from_toml(path).run.method == "mpcd":
                    yield name, path
            except MesokitError:  # a study
                continue


def shortened(path: Path, steps: int) -> Case:
    """The case with few steps, which all that it observes sees some of."""
    case = Case.from_toml(path)
    every = max(steps // 4, 1)
    observe = [dataclasses.replace(one, every=min(one.every, every)) for one in case.observe]
    run = dataclasses.replace(
        case.run, steps=steps, warmup=min(case.run.warmup, every), checkpoint_every=steps // 2,
        imbalance=0.0,
    )  # fmt: skip
    return dataclasses.replace(case, run=run, observe=observe)


class Ways:
    """The first so many of all ranks, as those that run a case."""

    def __init__(self, counts: set[int]) -> None:
        self.those: dict[int, Any] = {1: Alone()}
        for count in sorted(counts - {1}):
            some = ALL.Split(0 if ALL.rank < count else MPI.UNDEFINED)
            self.those[count] = None if ALL.rank >= count else Several(some)

    def run(self, way: str, make: Any) -> None:
        """Make a simulation of some threads, and run it, on so many ranks; the others wait."""
        ranks, threads = map(int, way.split("x"))
        if ALL.rank < ranks:
            world._known = self.those[ranks]
            make(threads).run(progress=False)
        wait(ALL.Ibarrier())


def kept(folder: Path) -> dict[str, bytes]:
    """All numbers that a run has left, by name."""
    found = {}
    with np.load(folder / "checkpoint.npz") as arrays:
        found |= {f"checkpoint {n}": arrays[n].tobytes() for n in arrays.files if n != "meta"}
    with h5py.File(folder / "run.h5") as file:

        def note(name: str, item: Any) -> None:
            if isinstance(item, h5py.Dataset) and item.dtype != object and "provenance" not in name:
                found[f"run.h5 {name}"] = np.asarray(item[()]).tobytes()

        file.visititems(note)
    log = folder / "log.csv"
    return found | ({"log": log.read_bytes()} if log.exists() else {})


def said(reference: dict[str, bytes], folder: Path) -> str:
    """Whether all numbers of a run are the same, or which are not."""
    other = kept(folder)
    names = reference.keys() | other.keys()
    found = sorted(name for name in names if reference.get(name) != other.get(name))
    return ", ".join(found[:3]) if found else "same"


def compared(path: Path, steps: int, runs: Ways, ways: list[str], resumed: list[str]) -> str:
    """What each way differs in, on rank 0."""
    folder = Path(ALL.bcast(tempfile.mkdtemp() if ALL.rank == 0 else None))
    file, lines = folder / "case.toml", []
    if ALL.rank == 0:
        file.write_text(shortened(path, steps).to_toml())
    wait(ALL.Ibarrier())
    runs.run("1x1", lambda threads: Simulation(file, output=folder / "one", threads=threads))
    reference = kept(folder / "one") if ALL.rank == 0 else {}
    for way in ways:
        where = folder / way
        runs.run(way, lambda threads, to=where: Simulation(file, output=to, threads=threads))
        lines.append(f"{way}: {said(reference, where)}" if ALL.rank == 0 else "")
    for way in resumed:
        where = folder / way
        first, then = way.split("-")

        def half(threads: int, to: Path = where) -> Simulation:
            case = Case.from_toml(file)
            run = dataclasses.replace(case.run, steps=steps // 2)
            return Simulation(dataclasses.replace(case, run=run), output=to, threads=threads)

        runs.run(first, half)
        runs.run(then, lambda threads, to=where: Simulation.resume(to, threads, steps))
        lines.append(f"{way}: {said(reference, where)}" if ALL.rank == 0 else "")
    if ALL.rank == 0:
        shutil.rmtree(folder)
    return "; ".join(lines)


def main() -> None:
    """A line for each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--ways", nargs="*", default=list(WAYS))
    parser.add_argument("--resumed", nargs="*", default=list(RESUMED))
    parser.add_argument("--steps", type=int, default=40)
    given = parser.parse_args()
    report.save_all = lambda *_: []
    every = [*given.ways, *(way for pair in given.resumed for way in pair.split("-"))]
    runs = Ways({int(way.split("x")[0]) for way in every})
    for name, path in cases(given.names):
        began = time.monotonic()
        try:
            require_ranks(Case.from_toml(path), 2)
            line = compared(path, given.steps, runs, given.ways, given.resumed)
        except CaseError as error:  # of all ranks: nothing has begun
            line = f"refused: {error}"
        if ALL.rank == 0:
            print(f"{name}: {line} ({time.monotonic() - began:.0f} s)", flush=True)


if __name__ == "__main__":
    main()
