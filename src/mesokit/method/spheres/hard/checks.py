"""Combinations of sections that event-driven dynamics refuses, and contacts with walls."""

import math

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.geometry import walls
from mesokit.geometry.surface import Surface
from mesokit.method.spheres.common.checks import (
    check_floor,
    check_plates,
    check_spins,
    periodic_axes,
)
from mesokit.method.spheres.common.walls import surface_rows
from mesokit.seam.engine import Array

WALLS = walls.Walls(("no-slip", "slip", "diffuse"), moving=True, contact=walls.CONTACT)


def check_hard(case: Case) -> None:
    """Raise CaseError for a case without a meaning."""
    section, box = case.spheres, case.box
    pair, largest = section.collision, section.largest(box)
    section.check(box)
    for problem in WALLS.problems(case):
        raise CaseError(problem)
    for key, surface, _ in walls.surfaces(case):
        _check_contact(case, key, surface)
    contacts = wall_contacts(case)
    check_plates(case)
    if pair.friction and pair.tangential == -1.0:
        raise CaseError(
            f"spheres.collision.friction = {show(pair.friction)}: with tangential = -1 spheres are "
            "smooth; expected tangential above -1 (1: as rough as friction lets them be)"
        )
    turned = pair.rough or bool((contacts[:, 1] > -1).any())
    check_spins(case, turned, "spheres.collision.tangential above -1")
    for axis, length in periodic_axes(case):
        if length < 2 * largest:
            raise CaseError(
                f"box.size = {show(list(box.size))}: expected at least two diameters "
                f"({2 * largest:g}) along {axis}"
            )
    check_floor(case)
    section.start.check(case)


def _check_contact(case: Case, key: str, surface: Surface) -> None:
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


def wall_contacts(case: Case) -> Array:
    """Restitution (-1: as of pairs), tangential restitution, friction and temperature (0: none) of
    each row of walls, (walls, 4)."""
    pair, found = case.spheres.collision, []

    def value_of(surface: Surface, name: str, usual: float | None) -> float | None:
        own = None if surface.contact is None else getattr(surface.contact, name)
        return usual if own is None else own

    for _, surface in surface_rows(case).surfaces:
        tangential = value_of(surface, "tangential", pair.tangential)
        friction = value_of(surface, "friction", pair.friction)
        warm = surface.rule == "diffuse"
        found.append(
            (
                value_of(surface, "restitution", -1.0),
                -1.0 if surface.rule == "slip" else tangential,
                math.inf if friction is None else friction,
                value_of(surface, "temperature", case.spheres.kT) if warm else 0.0,
            )
        )
    return np.array(found, float).reshape(-1, 4)
