"""Measurements in processes of their own, so that none profits from another's warm caches."""

from __future__ import annotations

import json
import subprocess
import sys
from statistics import median
from typing import Any


def run(workload: str, threads: int, seconds: float) -> dict[str, Any]:
    """One timed run of a workload."""
    command = [sys.executable, "-m", "benchmarks.workloads", workload]
    command += ["--threads", str(threads), "--seconds", str(seconds)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def alternate(
    names: list[str], threads: int, rounds: int, seconds: float
) -> dict[str, list[dict[str, Any]]]:
    """Runs of several workloads in turn: A B A B ..."""
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in names}
    for name in names:
        run(name, threads, 0.0)  # compiles
    for _ in range(rounds):
        for name in names:
            found[name].append(run(name, threads, seconds))
    return found


def middle(runs: list[dict[str, Any]], key: str) -> float:
    """Median of one number over runs."""
    return float(median(one[key] for one in runs))
