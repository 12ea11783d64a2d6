"""Combinations of sections that rigid grains refuse."""

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry import walls
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.method.spheres.common.checks import (
    check_floor,
    check_plates,
    check_spins,
    periodic_axes,
)

WALLS = walls.Walls(
    moving=True,
    turning=True,
    opens=True,
    contact=("restitution", "friction", *walls.VIBRATION, *walls.MOTION, *walls.PUSHED),
)


def check_rigid(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    for problem in WALLS.problems(case):
        raise CaseError(problem)
    section.check(box)
    section.start.check(case)
    check_plates(case)
    reach, shut = section.reach(box), closed_axes(case.walls)
    for axis, length in periodic_axes(case):
        if length < 2 * reach:
            raise CaseError(
                f"box.size = {show(list(box.size))}: expected at least twice the largest diameter "
                f"({2 * reach:g}) along {axis}"
            )
        if length < 2 * (reach + section.skin_of(box, shut)):
            raise CaseError(
                f"spheres.skin = {show(section.skin)}: expected less than "
                f"{0.5 * length - reach:.3g}, half of the box along {axis} less the reach"
            )
    check_floor(case)
    check_spins(case, section.turns, "spheres.contact.friction above 0")
