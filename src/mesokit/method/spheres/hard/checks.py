"""What does not go together in a case of event-driven dynamics."""

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry import walls
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common import falls
from mesokit.method.spheres.common.wall import plates
from mesokit.method.spheres.hard.walls import wall_rows

WALLS = walls.Walls(("no-slip", "slip", "diffuse"), moving=True, contact=walls.CONTACT)


def check(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    section.check(box)
    for problem in WALLS.problems(case):
        raise CaseError(problem)
    for key, surface, _ in walls.surfaces(case):
        _contact(case, key, surface)
    wall_rows(case)
    plates.check_plates(case)
    _friction(case)
    _spins(case)
    largest = section.largest(box)
    shut = {axis for wall in case.walls for axis in wall.closed_axes}
    for axis, length in zip(box.axes, box.size, strict=True):
        if axis not in shut and length < 2 * largest:
            raise CaseError(
                f"box.size = {show(list(box.size))}: expected at least two diameters "
                f"({2 * largest:g}) along {axis}"
            )
    falls.check_floor(case)
    section.start.check(case)


def _contact(case: Case, key: str, surface: Surface) -> None:
    """A surface reflects spheres, which takes restitution and friction, or is warm."""
    contact, diffuse = surface.contact, surface.rule == "diffuse"
    if contact is None:
        return
    if contact.temperature is not None and not diffuse:
        raise CaseError(
            f"{key}.contact.temperature = {show(contact.temperature)}: only with {key}.rule = "
            "'diffuse'"
        )
    for name in ("restitution", "tangential", "friction") if diffuse else ():
        if (value := getattr(contact, name)) is not None:
            raise CaseError(
                f"{key}.contact.{name} = {show(value)}: no effect with {key}.rule = 'diffuse', "
                "which sends spheres out with the wall's temperature; leave it out"
            )
    own = contact.tangential
    smooth = (case.spheres.collision.tangential if own is None else own) == -1.0
    if contact.friction is not None and (smooth or surface.rule == "slip"):
        raise CaseError(
            f"{key}.contact.friction = {show(contact.friction)}: no effect on a smooth surface; "
            f"expected {key}.contact.tangential above -1"
            + (f" and another {key}.rule than 'slip'" if surface.rule == "slip" else "")
        )


def _spins(case: Case) -> None:
    """Spins have no effect where nothing turns spheres."""
    section = case.spheres
    turned = section.collision.rough or bool((wall_rows(case).contacts[:, 1] > -1).any())
    if section.spin_kT and not turned:
        raise CaseError(
            f"spheres.spin_kT = {show(section.spin_kT)}: no effect on smooth spheres, which "
            "nothing turns; leave it out, or expected spheres.collision.tangential above -1"
        )


def _friction(case: Case) -> None:
    """Friction acts on what is not smooth."""
    pair = case.spheres.collision
    if pair.friction and pair.tangential == -1.0:
        raise CaseError(
            f"spheres.collision.friction = {show(pair.friction)}: with tangential = -1 spheres are "
            "smooth; expected tangential above -1 (1: as rough as friction lets them be)"
        )
