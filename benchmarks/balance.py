"""Borders that follow the work: three cases that an even division shares badly.

    python -m benchmarks.balance                 (a table, and docs/images/balance.png)
    mpiexec -n 4 python -m benchmarks.balance --one posts --limit 0.05 --windows 40

The second form is one run, whose rank 0 prints a JSON line.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from statistics import mean, median
from typing import Any

import numpy as np

from benchmarks import ranks as ranks_of
from mesokit import (
    WCA,
    Box,
    Case,
    Cuboid,
    Disk,
    Fluid,
    MaxwellBoltzmann,
    Polymer,
    Run,
    Solutes,
    Uniform,
)

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "balance.png"
NEVER, LIMIT = 1.0, 0.05
LAST = 10  # windows at the end, of which the imbalance is the mean
CASES = {
    "half solid": "32 x 32 x 32, solid where z > 16",
    "posts": "2D, 160 x 160, 50 posts of radius 3 in a corner of 73 x 73",
    "beads": "40^3, 5,000 beads in an octant, 10 sub-steps",
}


def case(name: str, limit: float) -> Case:
    """One of the three; `limit` is `run.imbalance`."""
    run = Run(steps=10**9, imbalance=limit)
    if name == "half solid":
        fluid = Fluid(density=10, thermostat=MaxwellBoltzmann(), force=Uniform([0.001, 0, 0]))
        solid = Cuboid(centre=[16, 16, 24], size=[32, 32, 16])
        return Case(run=run, box=Box([32] * 3), fluid=fluid, walls=[solid])
    if name == "posts":
        fluid = Fluid(density=10, thermostat=MaxwellBoltzmann(), force=Uniform([0.001, 0]))
        posts = [Disk(centre=centre, radius=3.0) for centre in corner_posts()]
        return Case(run=run, box=Box([160, 160]), fluid=fluid, walls=posts)
    beads = Solutes((Polymer(5000, 1),), pair=WCA(), mass=10.0, substeps=10)
    return Case(run=run, box=Box([40] * 3), fluid=Fluid(density=10), solutes=beads)


def corner_posts() -> np.ndarray:
    """Centres (50, 2) at random, no two nearer than 8."""
    random, found = np.random.default_rng(1), np.zeros((0, 2))
    while len(found) < 50:
        place = 4.0 + 65.0 * random.random(2)
        if not len(found) or np.linalg.norm(found - place, axis=1).min() >= 8.0:
            found = np.vstack([found, place])
    return found


def octant() -> np.ndarray:
    """Places (5000, 3) of a lattice that fills an octant of 40^3."""
    grid = np.stack(np.meshgrid(*[np.arange(18) + 0.5] * 3, indexing="ij"), -1)
    return grid.reshape(-1, 3)[:5000] * (20 / 18)


def one(name: str, limit: float, windows: int) -> dict[str, Any] | None:
    """Run so many times from sort to sort."""
    from mpi4py import MPI

    from mesokit.method.mpcd.engine.domains.engine import Ranks
    from mesokit.method.mpcd.start.fluid import start

    comm = MPI.COMM_WORLD
    engine = Ranks(case(name, limit), 1, [], comm)
    start(engine, beads=octant() if name == "beads" else None)
    every = engine.numbers.sort_every
    engine.advance(1)
    comm.Barrier()
    began, trace = MPI.Wtime(), []
    for _ in range(windows):
        engine.advance(every)
        blocks = [(*block.low, *block.high) for block in engine.domain.tree.blocks]
        trace.append((engine.step, float(engine.balancing.last), blocks))
    comm.Barrier()
    spent = MPI.Wtime() - began
    if comm.rank:
        return None
    return {"seconds": spent, "trace": trace, "moves": len(engine.balancing.moves)}


def run(name: str, ranks: int, limit: float, windows: int) -> dict[str, Any]:
    """The same, in processes of its own."""
    words = "--one", name, "--limit", limit, "--windows", windows
    found: dict[str, Any] = ranks_of.said("benchmarks.balance", ranks, *words)
    return found


def late(found: dict[str, Any]) -> float:
    """Most over mean of the ranks' work in the last windows."""
    return mean(row[1] for row in found["trace"][-LAST:])


def table(counts: list[int], windows: int, rounds: int) -> Iterator[str]:
    """With and without moves, in turn."""
    yield (
        "| case | ranks | most over mean, borders fixed | moving | moves | "
        "seconds, fixed | moving | ratio |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    kept = {}
    for name, about in CASES.items():
        for ranks in counts:
            run(name, ranks, LIMIT, 4)  # compiles
            pairs = [[run(name, ranks, limit, windows) for limit in (NEVER, LIMIT)]
                     for _ in range(rounds)]  # fmt: skip
            fixed, moving = pairs[-1]
            kept[name, ranks] = moving
            times = [[one["seconds"] for one in pair] for pair in pairs]
            ratio = median(a / b for a, b in times)
            yield (
                f"| {about} | {ranks} | {late(fixed):.2f} | {late(moving):.2f} | "
                f"{moving['moves']} | {median(t[0] for t in times):.1f} | "
                f"{median(t[1] for t in times):.1f} | {ratio:.2f} |"
            )
    picture({name: kept[name, counts[-1]] for name in CASES})


def picture(found: dict[str, dict[str, Any]]) -> None:
    """Where the first cuts along each axis lie, and the imbalance, against steps."""
    import matplotlib.pyplot as plt

    from mesokit.report.style import COLOURS, LINES, STYLE

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, len(found), figsize=(9.6, 5.0), sharex="col")
        for column, (name, run_) in enumerate(found.items()):
            steps = [row[0] for row in run_["trace"]]
            size = max(max(block) for block in run_["trace"][0][2])
            d = len(run_["trace"][0][2][0]) // 2
            for k in range(d):
                lines = sorted({block[k] for row in run_["trace"] for block in row[2]} - {0})
                first = True
                for n in range(max(len(cuts(row, k)) for row in run_["trace"]) if lines else 0):
                    at = [cuts(row, k)[n] if n < len(cuts(row, k)) else np.nan
                          for row in run_["trace"]]  # fmt: skip
                    axes[0, column].step(
                        steps, at, where="post", color=COLOURS[k], linestyle=LINES[k],
                        label=f"across {'xyz'[k]}" if first else None,
                    )  # fmt: skip
                    first = False
            axes[0, column].set(title=name, ylim=(0, size))
            axes[0, column].legend(loc="best")
            axes[1, column].plot(steps, [row[1] for row in run_["trace"]], "-", color=COLOURS[0])
            axes[1, column].axhline(1.0, color="0.5", linewidth=0.8)
            axes[1, column].set(xlabel="step")
        axes[0, 0].set_ylabel("where borders lie  [cells]")
        axes[1, 0].set_ylabel("most over mean of the work")
        figure.tight_layout()
        figure.savefig(PICTURE)


def cuts(row: Any, axis: int) -> list[int]:
    """Borders across an axis, of which the box begins with none."""
    return sorted({block[axis] for block in row[2]} - {0})


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--one", choices=CASES)
    parser.add_argument("--limit", type=float, default=LIMIT)
    parser.add_argument("--windows", type=int, default=40)
    parser.add_argument("--ranks", type=int, nargs="*", default=[2, 4])
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    if given.one:
        answer = one(given.one, given.limit, given.windows)
        if answer:
            print(json.dumps(answer))
    else:
        for line in table(given.ranks, given.windows, given.rounds):
            print(line, flush=True)
