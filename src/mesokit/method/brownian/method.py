"""Brownian motion: the record by which mesokit runs it."""

import math
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.case.amounts import count_text, duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.given.array_file import EXPECTED, array_in_file
from mesokit.case.given.outside_box import warn_outside
from mesokit.case.trajectory import Group, Kind, stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.errors import CaseError
from mesokit.method.brownian.engine import Brownians
from mesokit.method.brownian.section import Sections
from mesokit.observe import mean_square_displacement
from mesokit.observe.mean_square_displacement import MeanSquareDisplacement
from mesokit.processes.cores import usable_cores
from mesokit.seam.engine import Array, Integers
from mesokit.seam.method import Columns, InitialState, Method, Row, Summary

RATE = 14e6  # particle-steps per second of a thread, where the project measures (docs/benchmark.md)
BYTES = {2: 24, 3: 36}  # for each particle
MANY_SIGMA = 10.0  # of a normal number: none is ever as far
MOST_PARTICLES = 2**31 - 1  # numbers of random words are 32-bit


class Displacement(mean_square_displacement.Displacement):
    """The mean square displacement of free particles: 2 D t along each axis (Einstein 1905)."""

    def __init__(self, case: Case, observable: Any) -> None:
        if observable.of != "particles" or observable.kind is not None:
            raise CaseError("of: expected 'particles'; there are no molecules")
        chosen = observable.components or case.box.axes
        self.axes = tuple(case.box.index(axis, "components") for axis in chosen)
        self.length, self.number = 1, case.particles
        self.diffusion, self.timestep = case.brownian.diffusion, case.brownian.timestep

    def expected(self, steps: Integers) -> Array:
        return 2 * len(self.axes) * self.diffusion * self.timestep * steps

    def coefficient(self) -> tuple[float, str]:
        return self.diffusion, "exact"

    def legend(self) -> str:
        return f"{2 * len(self.axes)} D t"


def check(case: Case) -> None:
    """Raise CaseError for a box or a trajectory that has no meaning here."""
    if not 1 <= case.particles <= MOST_PARTICLES:
        raise CaseError(
            f"brownian.density = {show(case.brownian.density)}: {count_text(case.particles)} "
            f"particles in this box; expected 1 to {MOST_PARTICLES}"
        )
    steps, given = case.run.warmup + case.run.steps, case.brownian
    far = math.sqrt(2.0 * given.diffusion * given.timestep * steps)
    if MANY_SIGMA * far > 2.0**30 * min(case.box.size):
        raise CaseError(
            f"brownian.diffusion = {show(given.diffusion)}: in {steps} steps particles go so far "
            "that boxes cannot be counted; expected less"
        )


def groups(case: Case) -> tuple[Group, ...]:
    """One group of particles without a mass of their own: it is written as 1."""
    kinds = (Kind(1.0, case.brownian.number(case.box)),)
    return (Group("particles", kinds, has=("position", "image", "id")),)


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    threads = threads or usable_cores()
    given, d, steps = case.brownian, case.box.dimension, case.run.warmup + case.run.steps
    step = (2 * d * given.diffusion * given.timestep) ** 0.5
    memory = case.particles * BYTES[d] + 200_000_000
    stored = stored_bytes(case.trajectory, case.groups, d, case.run.steps)
    seconds = case.particles * steps / (RATE * threads)
    rows: list[Row] = [
        ("particles", f"{case.particles:,}".replace(",", " "), ""),
        ("length of a step", number(step, "length"), "root mean square"),
        ("displacement", number(step * steps**0.5, "length"), "root mean square, over the run"),
        ("run time", duration_text(seconds), f"estimate: {threads} thread{'s' * (threads > 1)}"),
        ("memory", size_text(memory), "estimate"),
    ]
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    warnings = [*run_warnings(case, memory, stored)]
    if step > 0.5 * min(case.box.size):
        warnings.append(f"brownian.timestep: a step is {step:.3g} long, more than half of the box")
    return Summary(tuple(rows), tuple(warnings), seconds, memory=memory)


def first_state(case: Case, arrays: Mapping[str, Any]) -> Array | None:
    """The positions to start from, None if they are to be drawn. Raises CaseError."""
    file = case.brownian.positions
    key = "positions" if file is None else f"brownian.positions = {file!r}"
    if not arrays and file is None:
        return None
    if arrays and file is not None:
        raise CaseError(f"{key}: not with an array of positions")
    shape, scale = (case.particles, case.box.dimension), case.brownian.scale
    try:
        given = (
            arrays["positions"] if file is None else array_in_file(file, "positions", shape, scale)
        )
        found = np.asarray(given, float)
    except OSError as error:
        raise CaseError(f"{key}: {EXPECTED}: {error.strerror}") from None
    except (ValueError, TypeError) as error:
        raise CaseError(f"{key}: expected an array of numbers: {error}") from None
    if found.shape != shape:
        raise CaseError(f"{key}: shape {found.shape}: expected {shape}")
    if not np.isfinite(found).all():
        raise CaseError(f"{key}: row {int(np.argwhere(~np.isfinite(found))[0][0])} is not finite")
    warn_outside(key, found, case.box)
    return found


def columns(case: Case) -> Columns:
    """Where the middle of all particles has gone to, of which the log of a run may tell."""
    names = tuple(f"centre {axis}" for axis in case.box.axes)

    def read(engine: Brownians, wanted: Collection[str]) -> dict[str, float]:
        centre = engine.positions(unwrapped=True).mean(axis=0)
        return {name: float(centre[names.index(name)]) for name in wanted}

    return Columns(names, names, read)


def _files(case: Case) -> dict[str, Path]:
    file = case.brownian.positions
    return {} if file is None else {"brownian.positions": Path(file)}


METHOD = Method(
    name="brownian",
    sections=Sections,
    observables=(MeanSquareDisplacement,),
    expected={"mean-square-displacement": Displacement},
    check=check,
    groups=groups,
    timestep=lambda case: float(case.brownian.timestep),
    summary=summary,
    initial=InitialState(first_state, Brownians.start, arrays=("positions",), files=_files),
    engine=lambda case, threads, measures: Brownians(case, threads),
    log=columns,
)
