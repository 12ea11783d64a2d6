"""Derived numbers of a case of a flock, cost, and warnings."""

import math
from collections.abc import Iterator

from mesokit import theory
from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.flock.section import BYTES, ball
from mesokit.processes.cores import usable_cores
from mesokit.seam.method import Row, Summary

# Seconds of a thread for a bird and for each bird that it looks at, where the project measures
SECONDS, EACH = {2: 40e-9, 3: 60e-9}, {2: 0.7e-9, 3: 1.0e-9}
FEW = 1.0  # birds in reach, below which hardly any two ever meet


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    threads = threads or usable_cores()
    given, d = case.flock, case.box.dimension
    steps = case.run.warmup + case.run.steps
    density = case.particles / float(free_volume(case))
    in_reach = density * ball(d, given.radius)
    memory = case.particles * BYTES[d] + 200_000_000
    stored = stored_bytes(case.trajectory, case.groups, d, case.run.steps)
    looked_at = min(density * (3 * given.radius) ** d, float(case.particles))
    bird = SECONDS[d] + EACH[d] * looked_at
    seconds = case.particles * steps * bird / threads
    step_length, memory_of = given.speed * given.timestep, given.noise.memory(d)
    of_reach = f"{step_length / given.radius:.3g} of the reach"
    rows: list[Row] = [
        ("birds", f"{case.particles:,}".replace(",", " "), ""),
        ("density", number(density, f"1/length^{d}"), ""),
        ("birds in reach", number(in_reach), "others, where birds are spread at random"),
        ("length of a step", number(step_length, "length"), of_reach),
        ("order without order", number(theory.disordered_order(case.particles, d)), "chance alone"),
    ]
    if (crowd := given.noise.crowd(d, case.particles)) is not None:
        both = "none", "order and disorder are both stable"
        many = both if math.isnan(crowd.many) else (number(crowd.many), "of infinitely many birds")
        rows.append(("order if all see all", *many))
    rows += [
        ("memory of a lone bird", number(memory_of), "mean cosine of its turn in a step"),
        ("run time", duration_text(seconds), f"estimate: {threads} thread{'s' * (threads > 1)}"),
        ("memory", size_text(memory), "estimate"),
    ]
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    warnings = [*run_warnings(case, memory, stored), *_warnings(case, in_reach)]
    numbers = {"birds": case.particles, "density": density, "birds_in_reach": in_reach}
    return Summary(tuple(rows), tuple(warnings), seconds, numbers, memory)


def _warnings(case: Case, in_reach: float) -> Iterator[str]:
    given = case.flock
    step_length = given.speed * given.timestep
    if in_reach < FEW:
        yield (
            f"flock.radius = {show(given.radius)}: {in_reach:.3g} birds in reach on average: "
            "hardly any two meet"
        )
    if step_length > given.radius:
        yield (
            f"flock.speed = {show(given.speed)}: birds fly {step_length:.3g} in a step, farther "
            f"than they see ({given.radius:.3g})"
        )
    if case.run.warmup == 0 and case.observe and given.start.run is None:
        yield "run.warmup = 0: order takes time to grow, and the mean counts from the first step"
    if given.noise.memory(case.box.dimension) == 1 and given.cohesion is None:
        yield f"flock.noise.strength = {show(given.noise.strength)}: no bird ever errs"
