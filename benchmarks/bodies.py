"""Spheres that move in a fluid, beside the same spheres in LAMMPS, by their share of the volume."""

from __future__ import annotations

import math
from collections.abc import Iterator
from statistics import median

from benchmarks import lammps_peer, once
from mesokit import SRD, BodyStart, Box, Case, Fluid, Run, SphereBody

RADIUS = 4.0
BOXES = {0: 32, 2: 35, 3: 33}  # spheres along an axis: side of the box
REQUIRED, MOST_COST = 5.0, 1.8  # over LAMMPS; time of a particle over that in an empty box


def case(along: int, virtual: str) -> Case:
    """So many spheres along each axis, on a lattice."""
    spheres = SphereBody(
        radius=RADIUS, number=max(along, 1) ** 3, virtual=virtual, start=BodyStart(rule="lattice")
    )
    return Case(
        run=Run(steps=10**9),
        box=Box([BOXES[along]] * 3),
        fluid=Fluid(density=10, timestep=0.1, collision=SRD(angle=90)),
        bodies=(spheres,) if along else (),
    )


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Million particle-steps per second, ours and theirs, in turn."""
    lammps_peer.install()
    yield "## Bodies that move"
    yield ""
    yield (
        f"Spheres of R = {RADIUS:g} in 3D, no-slip, 10 particles a cell, SRD with 90 degrees, "
        "timestep 0.1, on a lattice; phi is their volume fraction. Million particle-steps per "
        "second of the fluid; ratios are medians of ratios of neighbouring runs. Ours has virtual "
        f"particles. LAMMPS {lammps_peer.version()} (`fix srd`, diffuse spheres) has none, and "
        '"without" is ours without them. Cost is the time of a particle over that in the empty '
        f"box, which is to be below {MOST_COST:g}."
    )
    yield ""
    yield (
        "| phi | threads | ours | cost | without | LAMMPS | its cost | ratio | ratio without | "
        "asked for |"
    )
    yield "|---|---|---|---|---|---|---|---|---|---|"
    for threads in (1, 2):
        empty: tuple[float, float] | None = None
        for along, side in BOXES.items():
            names = [f"D-{along}-{virtual}" for virtual in ("fill", "none")]
            for name in names:
                once.run(name, threads, 0.0)
            rows = [
                (
                    *(float(once.run(name, threads, seconds)["rate"]) / 1e6 for name in names),
                    lammps_peer.measure_spheres(along, side, threads, seconds) / 1e6,
                )
                for _ in range(rounds)
            ]
            ours, none, theirs = (median(column) for column in zip(*rows, strict=True))
            empty = empty or (ours, theirs)
            share = along**3 * 4 / 3 * math.pi * RADIUS**3 / side**3
            yield (
                f"| {share:.3f} | {threads} | {ours:.1f} | {empty[0] / ours:.2f} | {none:.1f} | "
                f"{theirs:.1f} | {empty[1] / theirs:.2f} | "
                f"{median(row[0] / row[2] for row in rows):.2f} | "
                f"{median(row[1] / row[2] for row in rows):.2f} | {REQUIRED:g} |"
            )
    yield ""
