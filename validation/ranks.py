"""Every example and template, made short, on ranks and threads in any mixture: the same bits.

    python -m validation.ranks [--ways 1x2 2x1 3x1 4x2 8x1] [--resumed 3x1-2x1] [--steps 40] [names]

Each case runs on one process first, then in each of the ways (ranks x threads), with borders that
move whenever work differs; then to its middle in one way and on from there in another. What is
compared: the arrays of the checkpoint, of run.h5 (results and frames) and the log. A line for each
case.
"""

from __future__ import annotations

import argparse
import dataclasses
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from mesokit import Case, MesokitError

ROOT = Path(__file__).parents[1]
PLACES = "examples/*.toml", "examples/*/*.toml", "src/mesokit/method/mpcd/templates/*.toml"
WAYS = "1x2", "2x1", "3x1", "4x2", "8x1"
RESUMED = ("3x1-2x1",)


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


def mesokit(*words: Any) -> None:
    """Run the command; raises what it says."""
    command = [sys.executable, "-m", "mesokit", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])


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


def different(one: dict[str, bytes], other: dict[str, bytes]) -> list[str]:
    """Names of what is not the same."""
    return sorted(name for name in one.keys() | other.keys() if one.get(name) != other.get(name))


def words(way: str) -> tuple[str, ...]:
    """How the command is told of ranks and threads."""
    ranks, threads = way.split("x")
    return "--ranks", ranks, "--threads", threads, "--quiet"


def compared(path: Path, steps: int, ways: list[str], resumed: list[str]) -> Iterator[str]:
    """What each way differs in."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        file = folder / "case.toml"
        file.write_text(shortened(path, steps).to_toml())
        mesokit("run", file, "--output", folder / "one", "--threads", 1, "--quiet")
        reference = kept(folder / "one")
        for way in ways:
            mesokit("run", file, "--output", folder / way, *words(way))
            yield f"{way}: {said(reference, folder / way)}"
        for ways_ in resumed:
            first, then = ways_.split("-")
            half = f"run.steps={steps // 2}"
            mesokit("run", file, "--output", folder / ways_, "--set", half, *words(first))
            mesokit("resume", folder / ways_, "--steps", steps, *words(then))
            yield f"{ways_}: {said(reference, folder / ways_)}"


def said(reference: dict[str, bytes], folder: Path) -> str:
    """Whether all numbers of a run are the same, or which are not."""
    found = different(reference, kept(folder))
    return ", ".join(found[:3]) if found else "same"


def main() -> None:
    """A line for each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--ways", nargs="*", default=list(WAYS))
    parser.add_argument("--resumed", nargs="*", default=list(RESUMED))
    parser.add_argument("--steps", type=int, default=40)
    given = parser.parse_args()
    for name, path in cases(given.names):
        try:
            line = "; ".join(compared(path, given.steps, given.ways, given.resumed))
        except (MesokitError, RuntimeError) as error:
            line = f"refused: {error}"
        print(f"{name}: {line}", flush=True)


if __name__ == "__main__":
    main()
