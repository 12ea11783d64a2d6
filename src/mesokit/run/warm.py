"""Compiling what a case runs, before it is run: for clusters, containers and wheels."""

import time
from pathlib import Path
from typing import NamedTuple

from mesokit.case.case import Case
from mesokit.kernels.kept import counts
from mesokit.run.simulation import Simulation

STEPS, EVERY = 8, 4  # steps in which all that a case observes is looked at


class Warmed(NamedTuple):
    """What was made for a case: kernels, parts, seconds, and why each kernel was made."""

    kernels: int
    parts: int
    seconds: float
    reasons: dict[str, str]


def shortened(path: Path, settings: dict[str, str], steps: int = STEPS) -> Case:
    """The case in a file with few steps, in which every observable looks at each fourth.

    Frames that average over a window are of one look.

    Raises CaseError.
    """
    plain = Case.from_toml(path, settings)
    every = {
        f"observe.{i + 1}.{key}": EVERY
        for i, one in enumerate(plain.observe)
        if not getattr(one, "steps", ())  # where steps are named, these are what is looked at
        for key in ("every", "window")
        if getattr(one, key, None)
    }
    return Case.from_toml(path, settings | {"run.steps": steps, "run.warmup": 0} | every)


def warm(path: Path, settings: dict[str, str], why: bool = False) -> Warmed:
    """Run a few steps of the case in a file, so that all it compiles is kept; `why` finds reasons.

    Raises MesokitError.
    """
    began, kernels, parts = time.perf_counter(), counts.kernels_made, counts.parts_made
    counts.reasons.clear()
    counts.explains = why
    Simulation(shortened(path, settings), threads=1).run(progress=False)
    made = counts.kernels_made - kernels, counts.parts_made - parts
    return Warmed(*made, time.perf_counter() - began, dict(counts.reasons))
