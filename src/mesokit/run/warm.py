"""Compiling what a case runs, before it is run: for clusters, containers and wheels."""

import time
from pathlib import Path
from typing import NamedTuple

from mesokit.case.case import Case
from mesokit.devices.names import CPU
from mesokit.kernels.kept import counts
from mesokit.run.simulation import Simulation

STEPS, EVERY = 8, 4  # steps of the run, and between samples of all observables


class Warmed(NamedTuple):
    """Numbers of compiled kernels and parts, seconds, and the reason for each kernel."""

    kernels: int
    parts: int
    seconds: float
    reasons: dict[str, str]


def shortened(path: Path, settings: dict[str, str], steps: int = STEPS) -> Case:
    """The case in a file with few steps; every observable takes a sample at each fourth.

    Frames that average over a window have one sample. Raises CaseError.
    """
    plain = Case.from_toml(path, settings)
    every = {
        f"observe.{i + 1}.{key}": EVERY
        for i, one in enumerate(plain.observe)
        if not getattr(one, "steps", ())  # samples at given steps need no other interval
        for key in ("every", "window")
        if getattr(one, key, None)
    }
    return Case.from_toml(path, settings | {"run.steps": steps, "run.warmup": 0} | every)


def warm(path: Path, settings: dict[str, str], why: bool = False, device: str = CPU) -> Warmed:
    """Run a few steps of the case in a file, so that its compiled code is kept; `why` adds reasons.

    Kernels of an emulated device are kept as those of the card that it stands for.

    Raises MesokitError.
    """
    began, kernels, parts = time.perf_counter(), counts.kernels_made, counts.parts_made
    counts.reasons.clear()
    counts.explains = why
    Simulation(shortened(path, settings), threads=1, device=device).run(progress=False)
    made = counts.kernels_made - kernels, counts.parts_made - parts
    return Warmed(*made, time.perf_counter() - began, dict(counts.reasons))
