"""The walls of a case of spheres, as files and pictures know them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.case.component import name_of, show
from mesokit.errors import CaseError
from mesokit.geometry import shape_protocol
from mesokit.geometry.solids.solids import solids_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mesokit.case.case import Case
    from mesokit.geometry.solids.solids import Solids
    from mesokit.geometry.surface import Surface


def check(case: Case) -> None:
    """Raise CaseError for a wall that the box cannot have."""
    box, seen = case.box, dict[str, int]()
    for i, wall in enumerate(case.walls):
        key = f"wall[#{i + 1}]"
        if box.dimension not in wall.dimensions:
            raise CaseError(f"{key}.shape = {show(name_of(wall))}: not in {box.dimension}D")
        for axis in wall.closed_axes:
            if axis not in box.axes:
                raise CaseError(f"{key}.axis = {show(axis)}: a 2D box has only 'x' and 'y'")
            if axis in seen:
                raise CaseError(f"{key}.axis = {show(axis)}: wall[#{seen[axis]}] closes it already")
            seen[axis] = i + 1
    for key, surface in surfaces(case):
        _motion(key, surface, box.dimension)


def surfaces(case: Case) -> Iterator[tuple[str, Surface]]:
    """All surfaces of the walls, each with its key."""
    for i, wall in enumerate(case.walls):
        for name, surface in wall.surfaces().items():
            yield f"wall[#{i + 1}].{name}", surface


def _motion(key: str, surface: Surface, dimension: int) -> None:
    velocity, contact = surface.velocity, surface.contact
    if velocity is not None and len(velocity) != dimension:
        raise CaseError(f"{key}.velocity = {show(list(velocity))}: expected {dimension} numbers")
    if contact is None:
        return
    for here, other in (("amplitude", "frequency"), ("frequency", "amplitude")):
        given = getattr(contact, here)
        if given > 0 and getattr(contact, other) == 0:
            raise CaseError(
                f"{key}.contact.{here} = {show(given)}: a vibration has an amplitude and a "
                f"frequency; expected {key}.contact.{other} as well"
            )


def closed_axes(case: Case) -> set[int]:
    """Numbers of the axes that walls close."""
    return {case.box.axes.index(axis) for axis in shape_protocol.closed_axes(case.walls)}


def solids(case: Case) -> Solids | None:
    """The solids that pictures show, None without any."""
    return solids_of(case) if case.walls else None
