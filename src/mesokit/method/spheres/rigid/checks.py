"""Combinations of sections that rigid grains refuse."""

import math

from mesokit.case.case import Case
from mesokit.case.component import name_of, show
from mesokit.errors import CaseError
from mesokit.geometry import walls
from mesokit.geometry.solids.solids import Solids
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common.checks import (
    check_box,
    check_floor,
    check_plates,
    check_spins,
    rubs,
)
from mesokit.method.spheres.common.walls import other_walls, surface_rows
from mesokit.method.spheres.rigid import scales

WALLS = walls.Walls(
    moving=True,
    turning=True,
    opens=True,
    contact=("restitution", "friction", *walls.VIBRATION, *walls.MOTION, *walls.PUSHED),
)
FEWEST = 6  # steps in a period of a plate that vibrates


def check_rigid(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    for problem in WALLS.problems(case):
        raise CaseError(problem)
    section.check(box)
    section.require_room(box)
    section.start.check(case)
    _check_walls(case)
    check_plates(case)
    _check_contact(case)
    _check_shear(case)
    check_box(case, "largest diameter")
    check_floor(case)
    check_spins(case, section.turns or rubs(case), "spheres.contact.friction above 0")
    _check_range(case)
    _check_step(case)


def _check_walls(case: Case) -> None:
    others = other_walls(case)
    surface_rows(case, others)
    if others:
        Solids(case.walls, case.box, only=others)
    keys = {f"wall[#{i + 1}]" for i in others}
    for key, surface, _ in walls.surfaces(case):
        _check_surface(key, surface, key.partition(".")[0] in keys)


def _check_surface(key: str, surface: Surface, other: bool) -> None:
    contact = surface.contact
    if contact is None:
        return
    if other and contact.amplitude > 0:
        raise CaseError(f"{key}.contact.amplitude = {show(contact.amplitude)}: only plates vibrate")
    if contact.friction and surface.rule == "slip":
        raise CaseError(
            f"{key}.contact.friction = {show(contact.friction)}: no effect with {key}.rule = "
            "'slip'; leave one out"
        )


def _check_contact(case: Case) -> None:
    """Rolling needs friction, and a solver that has it."""
    law, solver = case.spheres.contact, case.spheres.solver
    if law.rolling == 0:
        return
    given = f"spheres.contact.rolling = {show(law.rolling)}"
    if law.friction == 0 and not rubs(case):
        raise CaseError(
            f"{given}: no effect on smooth grains, which nothing turns; leave it out, or expected "
            "spheres.contact.friction above 0"
        )
    if not solver.rolls:
        raise CaseError(
            f"{given}: not with spheres.solver.rule = {show(name_of(solver))}; expected rule "
            "'gauss-seidel'"
        )


def _check_shear(case: Case) -> None:
    """Images that slide along x need a box that repeats along x and y, without solids."""
    box, given = case.box, case.box.shear_key
    if not box.sheared:
        return
    for i, wall in enumerate(case.walls):
        if not wall.closed_axes:
            raise CaseError(
                f"{given}: not with wall[#{i + 1}].shape = {show(name_of(wall))}, which has no "
                "place in images that slide; expected plates across z, or none"
            )
        for axis in sorted({"x", "y"} & set(wall.closed_axes)):
            raise CaseError(
                f"{given}: not with wall[#{i + 1}].axis = {show(axis)}: the box repeats along x "
                "and y; expected plates that move along themselves, and no shear of the box"
            )
    # with fewer cells across the flow, lists look along x where a neighbour was before it slid
    least = 3.001 * (case.spheres.reach(box) + scales.skin_of(case))
    if box.size[1] < least:
        raise CaseError(
            f"{given}: box.size = {show(list(box.size))}: expected at least {least:.3g} along y, "
            "three times the length of neighbour lists"
        )
    for axis, g in zip(box.axes, case.spheres.gravity, strict=False):
        if g and axis != "z":
            raise CaseError(
                f"{given}: not with spheres.gravity = {show(list(case.spheres.gravity))}: the box "
                f"repeats along {axis}; leave one out"
            )


def _check_range(case: Case) -> None:
    """Cohesion acts between neighbours on a list, so that it is shorter than the skin."""
    cohesion, skin = case.spheres.contact.cohesion, scales.skin_of(case)
    if cohesion is not None and cohesion.range >= skin:
        raise CaseError(
            f"spheres.contact.cohesion.range = {show(cohesion.range)}: expected less than the skin "
            f"of neighbour lists, {skin:.3g} (spheres.skin)"
        )


def _check_step(case: Case) -> None:
    """Steps are short against the passage of two grains, and against vibrations."""
    section, step = case.spheres, scales.timestep_of(case)
    longest = scales.longest_step(case, scales.usual_speed(case))
    if step >= longest:
        raise CaseError(
            f"spheres.timestep = {show(section.timestep)}: grains pass the skin of neighbour lists "
            f"({scales.skin_of(case):.3g}) in a step; expected less than {longest:.3g}"
        )
    for key, surface, _ in walls.surfaces(case):
        contact = surface.contact
        shaken = 0.0 if contact is None else contact.amplitude * contact.frequency
        if contact is not None and shaken > 0 and step * contact.frequency > 2 * math.pi / FEWEST:
            period = 2 * math.pi / contact.frequency
            raise CaseError(
                f"{key}.contact.frequency = {show(contact.frequency)}: a period has "
                f"{period / step:.3g} steps; expected at least {FEWEST}, spheres.timestep of at "
                f"most {period / FEWEST:.3g}"
            )
