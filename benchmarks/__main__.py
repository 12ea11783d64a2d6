"""Run all benchmarks, alternating with the peer, and write docs/benchmark.md.

python -m benchmarks [--rounds 5] [--seconds 3] [--only PART,PART]

Parts: peers, ranks, cost, solids, bodies, bonded, solutes, event-driven, soft,
contact-dynamics, flocks, kinetic-monte-carlo, observe, memory, startup.
"""

from __future__ import annotations

import argparse
import datetime
import platform
from pathlib import Path

from benchmarks import (
    bodies,
    bonded,
    contact_dynamics,
    costs,
    event_driven,
    flocks,
    kinetic_monte_carlo,
    peers,
    ranks,
    soft_spheres,
    solutes,
    startup,
)

PARTS = {
    "peers": peers.table,
    "ranks": ranks.speed,
    "cost": costs.rules,
    "solids": costs.solids,
    "bodies": bodies.table,
    "bonded": bonded.table,
    "solutes": solutes.table,
    "event-driven": event_driven.table,
    "soft": soft_spheres.table,
    "contact-dynamics": contact_dynamics.table,
    "flocks": flocks.table,
    "kinetic-monte-carlo": kinetic_monte_carlo.table,
    "observe": costs.observables,
    "memory": costs.memory,
    "startup": startup.table,
}
PAGE = Path(__file__).resolve().parent.parent / "docs" / "benchmark.md"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="runs of each, alternating")
    parser.add_argument("--seconds", type=float, default=3.0, help="length of a run")
    parser.add_argument("--only", default=",".join(PARTS), help="parts to run")
    given = parser.parse_args()
    lines = ["# Benchmark", "", "Made by `make bench`. Medians over alternating runs."]
    lines += ["", f"{datetime.date.today()}, {_machine()}.", ""]
    for part in given.only.split(","):
        for line in PARTS[part](given.rounds, given.seconds):
            print(line, flush=True)
            lines.append(line)
        lines.append("")
    if given.only == ",".join(PARTS):
        PAGE.write_text("\n".join(lines))
        print(f"wrote {PAGE.relative_to(Path.cwd())}")


def _machine() -> str:
    import os

    from mesokit.io.provenance import _processor

    return f"{_processor()}, {os.cpu_count()} cores, Python {platform.python_version()}"


if __name__ == "__main__":
    main()
