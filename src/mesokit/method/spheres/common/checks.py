"""Combinations of sections that spheres of all methods refuse, or warn of: walls, falls, spins."""

import math
from collections.abc import Iterator

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry import walls
from mesokit.geometry.shape_protocol import closed_axes


def periodic_axes(case: Case) -> list[tuple[str, float]]:
    """Names and lengths of the axes that no wall closes."""
    shut, box = closed_axes(case.walls), case.box
    pairs = zip(box.axes, box.size, strict=True)
    return [(axis, length) for axis, length in pairs if axis not in shut]


def check_box(case: Case, reach_name: str) -> None:
    """Raise CaseError for a box so narrow that a pair would be on a list twice; `reach_name`: what
    messages call the distance up to which two act on one another."""
    section, box = case.spheres, case.box
    reach, shut = section.reach(box), closed_axes(case.walls)
    for axis, length in periodic_axes(case):
        if length < 2 * reach:
            raise CaseError(
                f"box.size = {show(list(box.size))}: expected at least twice the {reach_name} "
                f"({2 * reach:g}) along {axis}"
            )
        if length < 2 * (reach + section.skin_of(box, shut)):
            raise CaseError(
                f"spheres.skin = {show(section.skin)}: expected less than "
                f"{0.5 * length - reach:.3g}, half of the box along {axis} less the reach"
            )


def check_spins(case: Case, turned: bool, expected: str) -> None:
    """Raise CaseError for initial spins where nothing turns spheres."""
    if case.spheres.spin_kT and not turned:
        raise CaseError(
            f"spheres.spin_kT = {show(case.spheres.spin_kT)}: no effect on smooth spheres, which "
            f"nothing turns; leave it out, or expected {expected}"
        )


def check_plates(case: Case) -> None:
    """Raise CaseError for plates whose vibration leaves no room for the largest sphere."""
    box, largest = case.box, case.spheres.largest(case.box)
    for i, wall in enumerate(case.walls):
        for axis in wall.closed_axes:
            length = box.size[box.index(axis)]
            contacts = [surface.contact for surface in wall.surfaces().values()]
            moved = [contact.amplitude for contact in contacts if contact is not None]
            left = length - math.fsum(moved)
            if left < largest and any(moved):
                raise CaseError(
                    f"wall[#{i + 1}]: contact.amplitude = "
                    f"{' and '.join(f'{x:g}' for x in moved if x)}: "
                    f"leaves {max(left, 0.0):.3g} along {axis} to spheres of {largest:g}; expected "
                    f"less than {length - largest:.3g} in all"
                )


def open_falls(case: Case, time: float = 0.0) -> list[str]:
    """Axes along which gravity pulls and no plates are at a time; none where there are other
    walls."""
    standing = [wall for wall in case.walls if wall.opens is None or wall.opens > time]
    if any(not wall.closed_axes for wall in standing):
        return []
    shut, pulls = closed_axes(standing), zip(case.box.axes, case.spheres.gravity, strict=False)
    return [axis for axis, g in pulls if g and axis not in shut]


def check_floor(case: Case) -> None:
    """Raise CaseError without a wall below: spheres would fall for ever, faster and faster."""
    gravity, falls = case.spheres.gravity, open_falls(case)
    if falls and len(falls) == sum(1 for g in gravity if g):
        raise CaseError(
            f"spheres.gravity = {show(list(gravity))}: nothing ends the fall along {falls[0]}; "
            "expected a wall"
        )


def warnings_of_falls(case: Case, rough: bool) -> Iterator[str]:
    """Warn of gravity along smooth plates; `rough`: friction may hold the spheres."""
    for axis in open_falls(case) if not rough else ():
        yield (
            f"spheres.gravity: nothing holds what falls along {axis}: no wall is there, and "
            "plates and spheres are smooth"
        )


def rubs(case: Case) -> bool:
    """Whether a wall has friction of its own."""
    contacts = [surface.contact for _, surface, _ in walls.surfaces(case)]
    return any(contact is not None and bool(contact.friction) for contact in contacts)
