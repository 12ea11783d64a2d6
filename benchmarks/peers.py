"""Side by side with LAMMPS: the same workloads in turn, on one thread (rank) and on two."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median

from benchmarks import lammps_peer, once

REQUIRED = {"W1": 5.0, "W2": 4.5, "W3": 5.0, "W4": 4.0}
WHAT = {
    "W1": "3D periodic 30^3",
    "W2": "3D periodic 64^3",
    "W3": "3D slit 30^3, force",
    "W4": "2D periodic 160^2",
}


def table(rounds: int, seconds: float) -> Iterator[str]:
    """Lines of the table: million particle-steps per second, and ratios pair by pair."""
    lammps_peer.install()
    yield f"## Beside LAMMPS {lammps_peer.version()} `fix srd`"
    yield ""
    yield "Million particle-steps per second; ratios are medians of ratios of neighbouring runs."
    yield ""
    yield "| workload | threads | mesokit | LAMMPS | ratio | smallest | largest | asked for |"
    yield "|---|---|---|---|---|---|---|---|"
    ours: dict[tuple[str, int], float] = {}
    for name in lammps_peer.WORKLOADS:
        for threads in (1, 2):
            once.run(name, threads, 0.0)
            pairs = [
                (once.run(name, threads, seconds)["rate"],
                 lammps_peer.measure(name, threads, seconds))
                for _ in range(rounds)
            ]  # fmt: skip
            ratios = sorted(a / b for a, b in pairs)
            mine, theirs = (median(side) / 1e6 for side in zip(*pairs, strict=True))
            ours[name, threads] = mine
            yield (
                f"| {name} {WHAT[name]} | {threads} | {mine:.1f} | {theirs:.1f} | "
                f"{median(ratios):.2f} | {ratios[0]:.2f} | {ratios[-1]:.2f} | {REQUIRED[name]} |"
            )
    yield ""
    yield "Two threads over one: " + ", ".join(
        f"{name} {ours[name, 2] / ours[name, 1]:.2f}" for name in lammps_peer.WORKLOADS
    )
