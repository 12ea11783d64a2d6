"""Combinations of values that are fine alone and have no physics together."""

import math
from collections.abc import Iterator
from itertools import chain

from mesokit.case.amounts import count_text
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.warnings import require_memory
from mesokit.errors import CaseError
from mesokit.geometry.walls import Walls, room
from mesokit.method.flock.section import BYTES, DENSITY

MOST_BIRDS = 2**31 - 1  # their numbers are 32-bit
MOST_BOXES = 2.0**30  # crossed in a run: counts are 32-bit
LONGEST_STEP = 0.5  # of the box, in a step


def check(case: Case) -> None:
    """Raise CaseError, with the key first."""
    for message in chain(_birds(case), _walls(case)):
        raise CaseError(message)


def room_in_memory(case: Case) -> None:
    """Raise CaseError if this machine cannot hold the birds: when a run begins, not before."""
    given = case.flock
    key = "density" if given.number is None else "number"
    needed = given.birds(case.box) * BYTES[case.box.dimension]
    require_memory(f"flock.{key}", getattr(given, key) or DENSITY, needed)


def _birds(case: Case) -> Iterator[str]:
    given, least = case.flock, min(case.box.size)
    birds = given.birds(case.box)
    if not 1 <= birds <= MOST_BIRDS:
        key = "density" if given.number is None else "number"
        yield (
            f"flock.{key} = {show(getattr(given, key))}: {count_text(birds)} birds in this box; "
            f"expected 1 to {MOST_BIRDS}"
        )
    step_length = given.speed * given.timestep
    if step_length > LONGEST_STEP * least:
        yield (
            f"flock.speed = {show(given.speed)}: a step of {step_length:.4g} is more than half "
            f"of the box; expected at most {LONGEST_STEP * least / given.timestep:.4g}"
        )
    steps = case.run.warmup + case.run.steps
    if step_length * steps > MOST_BOXES * least:
        yield (
            f"flock.speed = {show(given.speed)}: in {steps} steps birds go so far that boxes "
            "cannot be counted; expected less"
        )
    if given.radius > math.hypot(*case.box.size):
        yield (
            f"flock.radius = {show(given.radius)}: longer than the diagonal of the box; expected "
            f"at most {math.hypot(*case.box.size):.4g}, where all see one another"
        )
    cohesion = given.cohesion
    if cohesion is not None and cohesion.attraction > given.radius:
        yield (
            f"flock.cohesion.attraction = {show(cohesion.attraction)}: beyond flock.radius = "
            f"{show(given.radius)}, beyond which birds do not interact; expected less"
        )


def _walls(case: Case) -> Iterator[str]:
    """Solids at rest that mirror birds or send them back."""
    if case.walls and any(length != int(length) for length in case.box.size):
        yield f"box.size = {show(list(case.box.size))}: with walls, expected whole numbers of cells"
    yield from Walls().problems(case)
    if case.walls:
        yield from room(case, "birds")
