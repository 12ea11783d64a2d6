"""What does not go together in a case of event-driven dynamics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.event_driven.walls import wall_rows
from mesokit.spheres import falls
from mesokit.spheres.wall import plates, solids

if TYPE_CHECKING:
    from mesokit.case.case import Case


def check(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    section.check(box)
    solids.check(case)
    for key, surface in solids.surfaces(case):
        if surface.rotation is not None:
            raise CaseError(
                f"{key}.rotation = {show(surface.rotation)}: not with method 'event-driven'"
            )
        warmth = None if surface.contact is None else surface.contact.temperature
        if warmth is not None and surface.rule != "diffuse":
            raise CaseError(
                f"{key}.contact.temperature = {show(warmth)}: only with {key}.rule = 'diffuse'"
            )
    wall_rows(case)
    plates.check(case)
    _friction(case)
    largest = section.largest(box)
    shut = {axis for wall in case.walls for axis in wall.closed_axes}
    for axis, length in zip(box.axes, box.size, strict=True):
        if axis not in shut and length < 2 * largest:
            raise CaseError(
                f"box.size = {show(list(box.size))}: expected at least two diameters "
                f"({2 * largest:g}) along {axis}"
            )
    falls.check(case)
    section.start.check(case)


def _friction(case: Case) -> None:
    """Friction acts on what is not smooth."""
    pair = case.spheres.collision
    if pair.friction and pair.tangential == -1.0:
        raise CaseError(
            f"spheres.collision.friction = {show(pair.friction)}: with tangential = -1 spheres are "
            "smooth; expected tangential above -1 (1: as rough as friction lets them be)"
        )
