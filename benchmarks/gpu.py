"""Run workloads on a card, each in a process of its own, and write docs/benchmark-gpu.md.

python -m benchmarks.gpu [--device cuda] [--seconds 3] [--only WORKLOAD,WORKLOAD]

With `--device emulated` and small workloads, such as W1@6, it is a rehearsal without a card, which
writes no page: times of the processor say nothing of a card.
"""

from __future__ import annotations

import argparse
import datetime
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

from mesokit.devices.named import opened
from mesokit.errors import RunError

WORKLOADS = {
    "W1": "3D, 30³ cells",
    "W2": "3D, 64³",
    "W2@128": "3D, 128³",
    "W2@256": "3D, 256³",
    "W1-thermostat": "3D, 30³, thermostat",
    "W2@128-thermostat": "3D, 128³, thermostat",
    "W3@64": "slit, 64³, plates that fill",
    "W5-disks": "2D, 400 x 50, plates and 6 disks, thermostat",
    "B-dimers-5": "molecules of two beads, 5 sub-steps",
}
PAGE = Path(__file__).resolve().parent.parent / "docs" / "benchmark-gpu.md"
PEERS = "HOOMD-blue on an A100: 3.46e9/s. cudaMPCD, in float32: 4.3e9/s. Both as published."
ABOUT = f"""\
Particle-steps in a second are medians over rounds, sorts within; {PEERS}
The prediction is that of `mesokit check`. Each workload runs in a process of its own, beside a copy
of as many bytes as its positions and velocities take."""
OF_KERNELS = """\
Each launch was waited for, so times hold what a launch takes by itself. Bytes are the least that a
thread must read and write; what of them the caches save or repeat is not counted."""


def run(workload: str, device: str, seconds: float) -> dict[str, Any]:
    """What `benchmarks.on_device` says of a workload, or the last line of its error."""
    command = [sys.executable, "-m", "benchmarks.on_device", workload]
    command += ["--device", device, "--seconds", str(seconds)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no word of why"])[-1]
        return {"workload": workload, "refused": last}
    return dict(json.loads(done.stdout.splitlines()[-1]))


def speeds(found: list[dict[str, Any]]) -> Iterator[str]:
    """A row for each workload."""
    yield (
        "| workload | particles | particle-steps/s | least and most | predicted | bytes a particle "
        "| copy, TB/s |"
    )
    yield "|---|---|---|---|---|---|---|"
    for one in found:
        name = WORKLOADS.get(one["workload"], one["workload"])
        if "refused" in one:
            yield f"| {name} | {one['refused']} | | | | | |"
            continue
        rates = one["rates"]
        beside = "" if one["predicted"] is None else f"{one['predicted']:.2e}"
        yield (
            f"| {name} | {one['particles']:,} | {median(rates):.2e} "
            f"| {min(rates):.2e} to {max(rates):.2e} | {beside} "
            f"| {one['bytes'] / one['particles']:.0f} | {one['copy'] / 1e12:.3g} |"
        )


def kernels(one: dict[str, Any]) -> Iterator[str]:
    """A row for each kernel of a workload, the one that takes most first."""
    yield f"### {WORKLOADS.get(one['workload'], one['workload'])}"
    yield ""
    yield f"A launch that does nothing: {1e6 * one['launch']:.1f} microseconds."
    yield ""
    yield (
        "| kernel | threads | launches a step | microseconds | ps a particle-step "
        "| bytes a thread | TB/s | of the copy |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    by_time = sorted(
        one["kernels"].items(), key=lambda item: -item[1]["launches"] * item[1]["seconds"]
    )
    for name, kernel in by_time:
        seconds = kernel["seconds"]
        share = 1e12 * kernel["launches"] * seconds / one["particles"]
        moved = "| | |"
        if kernel["bytes"] is not None:
            speed = kernel["threads"] * kernel["bytes"] / seconds
            moved = f"{kernel['bytes']} | {speed / 1e12:.3g} | {speed / one['copy']:.2f} |"
        yield (
            f"| `{name}` | {kernel['threads']:,} | {kernel['launches']:.2f} | {1e6 * seconds:.1f} "
            f"| {share:.1f} | {moved}"
        )


def page(found: list[dict[str, Any]]) -> list[str]:
    """All lines, with the name of the card."""
    done = [one for one in found if "refused" not in one]
    cards = ", ".join(sorted({one["device"] for one in done})) or "no card"
    lines = ["# Benchmark on a card", "", "Made by `make bench-gpu`.", ""]
    lines += [f"{datetime.date.today()}, {cards}.", "", ABOUT, "", *speeds(found), ""]
    lines += ["## Kernels", "", OF_KERNELS, ""]
    for one in done:
        lines += [*kernels(one), ""]
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--seconds", type=float, default=3.0, help="length of a run")
    parser.add_argument("--only", default=",".join(WORKLOADS), help="workloads to run")
    given = parser.parse_args()
    try:
        opened(given.device)
    except RunError as error:
        sys.exit(f"benchmarks.gpu: error: {error}")
    found = []
    for workload in given.only.split(","):
        found.append(run(workload, given.device, given.seconds))
        print(f"{workload}: {found[-1].get('refused', 'done')}", file=sys.stderr, flush=True)
    lines = page(found)
    print("\n".join(lines))
    if given.device.startswith("cuda") and given.only == ",".join(WORKLOADS):
        PAGE.write_text("\n".join(lines), encoding="utf-8")
        print(f"wrote {PAGE}")


if __name__ == "__main__":
    main()
