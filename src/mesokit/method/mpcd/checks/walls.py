"""Walls that are fine alone and wrong together, or in this box: see `combinations`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from mesokit.case.box import AXES
from mesokit.case.component import name_of, one_of, show, tag_of
from mesokit.geometry.shape.intersection import Intersection
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import labels, solids_of
from mesokit.geometry.surface import Surface

if TYPE_CHECKING:
    from mesokit.case.case import Case


def walls(case: Case) -> Iterator[str]:
    """Shapes of this dimension; plates once for each axis; one rule for virtual particles."""
    seen: dict[str, int] = {}
    d = case.box.dimension
    for i, wall in enumerate(case.walls):
        key = f"wall[#{i + 1}]"
        if d not in wall.dimensions:
            from mesokit.geometry.shape import SHAPES

            known = [_shape(s) for s in SHAPES if d in getattr(s, "dimensions", ())]
            yield f"{key}.shape = {show(name_of(wall))}: not in {d}D; expected {one_of(known)}"
        for axis in wall.closed_axes:
            if axis in seen:
                yield f"{key}.axis = {show(axis)}: wall[#{seen[axis]}] closes it already"
            seen[axis] = i + 1
        if wall.virtual != case.walls[0].virtual:
            yield (
                f"{key}.virtual = {show(wall.virtual)}: expected {show(case.walls[0].virtual)} as "
                "for wall[#1]; all walls have one rule"
            )
    yield from _same_names(case)
    if case.fluid.mixed and any(wall.virtual == "top-up" for wall in case.walls):
        yield "wall[#1].virtual = 'top-up': not with species of different mass; use 'extrapolate'"


def _same_names(case: Case) -> Iterator[str]:
    """Forces are kept by the names of the solids."""
    seen: dict[str, int] = {}
    for i, label in enumerate(labels(case.walls)):
        if label in seen:
            first = f"wall[#{seen[label]}]"
            yield f"wall[#{i + 1}].name: {show(label)} is also the name of {first}; rename one"
        seen[label] = i + 1


def _shape(cls: type) -> str:
    """The name of a shape in a case file."""
    found = tag_of(cls)
    assert found is not None
    return found[1]


def contacts(case: Case) -> Iterator[str]:
    """What a surface does to spheres."""
    for key, surface, _ in surfaces(case):
        if surface.contact is not None:
            yield f"{key}.contact: not with method 'mpcd', whose particles have no size"


def moving_surfaces(case: Case) -> Iterator[str]:
    """Surfaces that move along themselves."""
    for key, surface, wall in surfaces(case):
        if isinstance(wall, Plates):
            yield from _moving_plate(key, surface, wall.axis)
        elif surface.rule == "slip" and surface.moves:
            name = "velocity" if any(surface.velocity or ()) else "rotation"
            yield f"{key}.{name}: a slip surface drags nothing; leave it out"
        if isinstance(surface.rotation, tuple) and (
            case.box.dimension == 2 or len(surface.rotation) != 3
        ):
            what = "one number in 2D" if case.box.dimension == 2 else "a number or three"
            yield f"{key}.rotation = {show(surface.rotation)}: expected {what}"
    if any(surface.moves and not isinstance(wall, Plates) for _, surface, wall in surfaces(case)):
        motion = solids_of(case).motion
        for i, wall in enumerate(case.walls):
            speed, across = motion.get(i, (0.0, 0.0))
            if not isinstance(wall, Plates) and across > 1e-6 * max(1.0, speed):
                yield (
                    f"wall[#{i + 1}].surface: its surface would move across itself, at "
                    f"{across:.3g}; expected a motion along the surface, such as the rotation "
                    "of something round"
                )


def _moving_plate(key: str, surface: Surface, axis: Any) -> Iterator[str]:
    velocity = surface.velocity
    if surface.rotation is not None:
        yield f"{key}.rotation = {show(surface.rotation)}: a plate does not turn"
    if velocity is None:
        return
    if velocity[AXES.index(axis)] != 0:
        yield (
            f"{key}.velocity = {show(velocity)}: a plate across {axis} moves only along "
            f"itself; expected 0 for {axis}"
        )
    if surface.rule == "slip" and any(velocity):
        yield f"{key}.velocity = {show(velocity)}: a slip plate drags nothing; leave it out"


def room(case: Case) -> Iterator[str]:
    """Solids that leave room, and fit the periodic box."""
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
        yield f"wall: the solids leave {solids.free_volume:.3g} cells to the fluid"
    for i in solids.without_surface():
        yield f"wall[#{i + 1}].{_absent(case.walls[i], case.box.size)}"


def _absent(wall: Any, box: tuple[int, ...]) -> str:
    """What is wrong with a solid of which no surface is in the box, key first."""
    known = ("radius", "size", "width", "parts", "of", "file")
    inside = wall.fluid == "inside"
    keys = known if inside else ("file", "parts", "of", *wall.vectors(), *known)
    key = next(key for key in keys if hasattr(wall, key))
    value = getattr(wall, key)
    text = f"{key} = {show(value)}" if key not in ("parts", "of") else key
    if inside:
        why = "with fluid = 'inside', what is to surround the fluid lies beyond its ends"
    elif isinstance(wall, Intersection):
        why = "the parts have nothing in common there"
    else:
        why = "expected it to reach into the box"
    return f"{text}: no surface in the box {show(box)}; {why}"


def surfaces(case: Case) -> Iterator[tuple[str, Surface, Any]]:
    for i, wall in enumerate(case.walls):
        for name, surface in wall.surfaces().items():
            yield f"wall[#{i + 1}].{name}", surface, wall
