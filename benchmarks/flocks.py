"""Flocks beside what people write with SciPy: a tree of the birds at each step.

    python -m benchmarks.flocks mesokit 100000 --threads 2 --seconds 3

prints one JSON line: bird-steps per second and bytes for each bird.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any

import numpy as np

from mesokit import AngularNoise, Box, Flock, Run, Simulation

DENSITY, NOISE, SPEED = 2.0, 2.0, 0.5
NUMBERS = (2_000, 20_000, 100_000, 1_000_000)
ASKED = 10.0  # times the tree


def engine(number: int, threads: int, density: float = DENSITY) -> Any:
    """Ours."""
    side = math.sqrt(number / density)
    given = Flock(number=number, speed=SPEED, noise=AngularNoise(NOISE))
    case = Simulation(
        run=Run(steps=0, method="flock"), box=Box([side, side]), flock=given, threads=threads
    )
    return case.engine


def tree(number: int) -> Callable[[], None]:
    """A step with a KD-tree: pairs in reach, and sums of headings over them."""
    from scipy.spatial import cKDTree

    side, random = math.sqrt(number / DENSITY), np.random.default_rng(1)
    places, angles = random.uniform(0, side, (number, 2)), random.uniform(-np.pi, np.pi, number)

    def step() -> None:
        pairs = cKDTree(places, boxsize=side).query_pairs(1.0, output_type="ndarray")
        one, other = np.concatenate([pairs, pairs[:, ::-1]]).T
        sums = [
            heading + np.bincount(one, heading[other], minlength=number)
            for heading in (np.cos(angles), np.sin(angles))
        ]
        angles[:] = np.arctan2(sums[1], sums[0]) + random.uniform(-NOISE / 2, NOISE / 2, number)
        places[:, 0] = (places[:, 0] + SPEED * np.cos(angles)) % side
        places[:, 1] = (places[:, 1] + SPEED * np.sin(angles)) % side

    return step


def timed(
    which: str, number: int, threads: int, seconds: float, density: float
) -> dict[str, float]:
    """Bird-steps per second, after order has grown for a while."""
    if which == "mesokit":
        ours = engine(number, threads, density)
        ours.advance(200)
        chunk = max(1, 2_000_000 // number)
        size = sum(
            array.nbytes for group in ours.flock for array in group if isinstance(array, np.ndarray)
        )

        def step() -> None:
            ours.advance(chunk)
    else:
        step, chunk, size = tree(number), 1, 0
        for _ in range(3):
            step()
    steps, began = 0, time.perf_counter()
    while steps == 0 or time.perf_counter() - began < seconds:
        step()
        steps += chunk
    rate = number * steps / (time.perf_counter() - began)
    return {"rate": rate, "bytes": size / number}


def run(which: str, number: int, threads: int, seconds: float, density: float = DENSITY) -> Any:
    """The same in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.flocks", which, str(number)]
    command += ["--threads", str(threads), "--seconds", str(seconds), "--density", str(density)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Ours on one thread and two, and the tree, in turn."""
    yield "## Flocks"
    yield ""
    yield (
        f"2D, density {DENSITY:g}, reach 1, speed {SPEED:g}, angular noise {NOISE:g}; million "
        "bird-steps per second. The peer is a `cKDTree` of SciPy at each step, with sums by NumPy, "
        "on one core. Ratios are medians of ratios of neighbouring runs."
    )
    yield ""
    yield "| birds | 1 thread | 2 threads | 2 over 1 | SciPy | 1 thread over SciPy | bytes a bird |"
    yield "|---|---|---|---|---|---|---|"
    run("mesokit", NUMBERS[0], 2, 0.0)  # compiles
    for number in NUMBERS:
        found = [
            (
                run("mesokit", number, 1, seconds),
                run("mesokit", number, 2, seconds),
                run("scipy", number, 1, seconds),
            )
            for _ in range(rounds)
        ]
        one, two, peer = (median(each[k]["rate"] for each in found) / 1e6 for k in range(3))
        twice = median(b["rate"] / a["rate"] for a, b, _ in found)
        ratio = median(a["rate"] / c["rate"] for a, _, c in found)
        size = found[0][0]["bytes"]
        yield (
            f"| {number:,} | {one:.1f} | {two:.1f} | {twice:.2f} | {peer:.2f} | {ratio:.0f} (asked "
            f"{ASKED:g}) | {size:.0f} |".replace(",", " ")
        )
    yield ""
    dense = [run("mesokit", 100_000, 1, seconds, 4.0)["rate"] / 1e6 for _ in range(rounds)]
    yield f"At a density of 4, 100 000 birds: {median(dense):.1f} on one thread."


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("which", choices=("mesokit", "scipy"))
    parser.add_argument("number", type=int)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--density", type=float, default=DENSITY)
    given = parser.parse_args()
    found = timed(given.which, given.number, given.threads, given.seconds, given.density)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
