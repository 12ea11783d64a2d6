"""Thermal equilibrium of spheres: when they are in it, and what they are like then."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from mesokit.case.case import Case
from mesokit.geometry.surface import Surface


class Equilibrium(NamedTuple):
    """Mean m v^2 along an axis, nan where it is not known beforehand, and whether walls keep
    centres off by a radius."""

    kT: float
    hard: bool


def surfaces(case: Case) -> Iterator[Surface]:
    """Surfaces of all walls."""
    for wall in case.walls:
        yield from wall.surfaces().values()


def still_walls(case: Case) -> bool:
    """True if no wall moves or vibrates."""
    return not any(
        surface.moves or (surface.contact is not None and surface.contact.amplitude > 0)
        for surface in surfaces(case)
    )


def of_start(case: Case) -> float:
    """Mean m v^2 along an axis of spheres that keep the kinetic energy that they started with; nan
    where they start from elsewhere."""
    section, n = case.spheres, case.particles
    if section.start.files():
        return math.nan
    free = n if case.walls or section.gravity else n - 1  # without them momentum is zero
    return float(section.kT * free / n)
