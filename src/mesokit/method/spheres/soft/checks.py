"""Combinations of sections that soft spheres refuse."""

from mesokit.case.case import Case
from mesokit.case.component import show
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
from mesokit.method.spheres.soft import scales
from mesokit.method.spheres.soft.pair.protocol import ContactLaw

ROUNDING = 1e-5  # relative, of diameters as people write them
WALLS = walls.Walls(
    moving=True,
    turning=True,
    opens=True,
    contact=("restitution", "friction", *walls.VIBRATION, *walls.MOTION),
)


def check_soft(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    for problem in WALLS.problems(case):
        raise CaseError(problem)
    section.check(box)
    section.start.check(case)
    _check_walls(case)
    check_plates(case)
    if not isinstance(section.pair, ContactLaw):
        _check_potential(case)
    check_box(case, "reach of the pair law")
    check_floor(case)
    if section.timestep is not None and isinstance(section.pair, ContactLaw):
        longest = scales.shortest_contact(case) / scales.REFUSED
        if section.timestep > longest:
            raise CaseError(
                f"spheres.timestep = {show(section.timestep)}: expected at most a tenth of the "
                f"contact time, {longest:.3g} (better a fiftieth)"
            )
    check_spins(case, section.turns or rubs(case), "spheres.pair.friction above 0")


def _check_walls(case: Case) -> None:
    touching, others = isinstance(case.spheres.pair, ContactLaw), other_walls(case)
    surface_rows(case, others)
    if others and not touching:
        raise CaseError(
            f"wall[#{others[0] + 1}]: a potential acts at plates, at round walls and within boxes; "
            "other shapes are for laws of contact"
        )
    if others:
        Solids(case.walls, case.box, only=others)
    keys = {f"wall[#{i + 1}]" for i in others}
    for key, surface, _ in walls.surfaces(case):
        _check_surface(key, surface, case, key.partition(".")[0] in keys)


def _check_surface(key: str, surface: Surface, case: Case, other: bool) -> None:
    contact, touching = surface.contact, isinstance(case.spheres.pair, ContactLaw)
    if contact is None:
        return
    if other and contact.amplitude > 0:
        raise CaseError(f"{key}.contact.amplitude = {show(contact.amplitude)}: only plates vibrate")
    if contact.restitution == 0:
        raise CaseError(f"{key}.contact.restitution = 0: expected more than 0")
    for name in ("restitution", "friction"):
        if not touching and (value := getattr(contact, name)) is not None:
            raise CaseError(f"{key}.contact.{name} = {show(value)}: a potential has none")
    if contact.friction and surface.rule == "slip":
        raise CaseError(
            f"{key}.contact.friction = {show(contact.friction)}: no effect with {key}.rule = "
            "'slip'; leave one out"
        )


def _check_potential(case: Case) -> None:
    """Raise CaseError unless spheres are equal, of the diameter of the potential."""
    section = case.spheres
    if section.speed is not None:
        raise CaseError(
            f"spheres.speed = {show(section.speed)}: only for laws of contact; with a potential "
            "give spheres.timestep"
        )
    kinds, scale = section.kinds, section.scale(case.box)
    if any(kind.spread for kind in kinds) or len({kind.diameter for kind in kinds}) > 1:
        raise CaseError("spheres.kinds: a potential acts between spheres of one diameter alone")
    given, own = kinds[0].diameter * scale, section.pair.diameter
    if abs(given - own) > ROUNDING * own:
        raise CaseError(
            f"spheres.kinds: diameter {given:.9g}; expected that of the potential, {own:.9g}: "
            "leave it out, and give number or density but no packing fraction"
        )
