"""What is fine alone and has no physics together."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from mesokit.case.amounts import count_text
from mesokit.case.component import name_of, show
from mesokit.case.warnings import require_memory
from mesokit.errors import CaseError
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import labels, solids_of
from mesokit.method.flock.section import BYTES, DENSITY

if TYPE_CHECKING:
    from mesokit.case.case import Case

MOST_BIRDS = 2**31 - 1  # their numbers are 32-bit
MOST_BOXES = 2.0**30  # crossed in a run: counts are 32-bit
LONGEST_WAY = 0.5  # of the box, in a step


def check(case: Case) -> None:
    """Raise CaseError, with the key first."""
    for found in (_birds(case), _walls(case)):
        for message in found:
            raise CaseError(message)
    if case.walls:
        for message in _room(case):
            raise CaseError(message)


def room_in_memory(case: Case) -> None:
    """Raise CaseError where this machine cannot hold them: when a run begins, not before."""
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
    way = given.speed * given.timestep
    if way > LONGEST_WAY * least:
        yield (
            f"flock.speed = {show(given.speed)}: a step of {way:.4g} is more than half of the box; "
            f"expected at most {LONGEST_WAY * least / given.timestep:.4g}"
        )
    steps = case.run.warmup + case.run.steps
    if way * steps > MOST_BOXES * least:
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
    """Solids that mirror birds or send them back, at rest."""
    if case.walls and any(length != int(length) for length in case.box.size):
        yield f"box.size = {show(list(case.box.size))}: with walls, expected whole numbers of cells"
    seen: dict[str, int] = {}
    names = labels(case.walls)
    for i, wall in enumerate(case.walls):
        key = f"wall[#{i + 1}]"
        if case.box.dimension not in wall.dimensions:
            yield f"{key}.shape = {show(name_of(wall))}: not in {case.box.dimension}D"
        for axis in wall.closed_axes:
            if axis not in case.box.axes:
                yield f"{key}.axis = {show(axis)}: a 2D box has only 'x' and 'y'"
            if axis in seen:
                yield f"{key}.axis = {show(axis)}: wall[#{seen[axis]}] closes it already"
            seen[axis] = i + 1
        if wall.virtual != "extrapolate":
            yield f"{key}.virtual = {show(wall.virtual)}: birds need no such; leave it out"
        if names[i] in names[:i]:
            yield f"{key}.name: {show(names[i])} is also the name of another wall; rename one"
        for name, surface in wall.surfaces().items():
            where, velocity = f"{key}.{name}", surface.velocity
            if velocity is not None and len(velocity) != case.box.dimension:
                yield (
                    f"{where}.velocity = {show(list(velocity))}: expected {case.box.dimension} "
                    "numbers"
                )
            if surface.rule == "diffuse":
                yield (
                    f"{where}.rule = 'diffuse': birds have no temperature; expected 'slip' or "
                    "'no-slip'"
                )
            if surface.moves:
                moved = "velocity" if any(surface.velocity or ()) else "rotation"
                yield f"{where}.{moved}: birds of method 'flock' need walls at rest; leave it out"
            if surface.contact is not None:
                yield f"{where}.contact: not with method 'flock', whose birds have no size"


def _room(case: Case) -> Iterator[str]:
    if all(isinstance(wall, Plates) for wall in case.walls):
        return
    solids = solids_of(case)
    for i, axis in enumerate(case.box.axes):
        gap = solids.misfit(i)
        if gap > 1e-6:
            yield (
                f"wall: the solids do not fit the periodic box along {axis}: at its two ends they "
                f"differ by {gap:.2g} cells; close it with plates, or repeat the shape"
            )
    if solids.free_volume < 1:
        yield f"wall: the solids leave {solids.free_volume:.3g} cells to the birds"
    for i in solids.without_surface():
        yield f"wall[#{i + 1}]: no surface in the box {show(case.box.size)}; expected one"
