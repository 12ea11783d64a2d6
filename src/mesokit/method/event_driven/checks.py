"""What does not go together in a case of event-driven dynamics."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.event_driven.walls import wall_rows
from mesokit.spheres.wall import solids

if TYPE_CHECKING:
    from mesokit.case.case import Case


def check(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    section.check(box)
    if box.sheared or box.shear is not None or box.shear_frequency:
        raise CaseError("box: not with shear in method 'event-driven'")
    if box.open:
        raise CaseError(f"box.open = {show(list(box.open))}: not with method 'event-driven'")
    solids.check(case)
    wall_rows(case)
    largest = section.largest(box)
    shut = {axis for wall in case.walls for axis in wall.closed_axes}
    for axis, length in zip(box.axes, box.size, strict=True):
        if axis not in shut and length < 2 * largest:
            raise CaseError(
                f"box.size = {show(list(box.size))}: expected at least two diameters "
                f"({2 * largest:g}) along {axis}"
            )
    _gravity(case, shut)
    section.start.check(case)


def _gravity(case: Case, shut: set[str]) -> None:
    """Without walls below spheres would fall for ever, faster and faster."""
    gravity = case.spheres.gravity
    falls = [axis for axis, g in zip(case.box.axes, gravity, strict=False) if g]
    round_walls = [wall for wall in case.walls if not wall.closed_axes]
    if falls and not round_walls and not set(falls) & shut:
        raise CaseError(
            f"spheres.gravity = {show(list(gravity))}: nothing ends the fall along {falls[0]}; "
            "expected a wall"
        )
