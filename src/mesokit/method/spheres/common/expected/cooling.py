"""Theory of the temperature of spheres in time."""

import math
from typing import NamedTuple

from mesokit import theory
from mesokit.case.case import Case


class Cooling(NamedTuple):
    """Whether spheres turn; the constant restitution of a uniform gas of equal smooth spheres, 1
    where energy is kept, nan of all others; the thermal energy that something holds, nan without;
    whether that has the fluctuations of a bath; and how long a collision takes."""

    turns: bool
    restitution: float = math.nan
    held: float = math.nan
    fluctuates: bool = False
    contact_time: float = 0.0


def uniform(case: Case) -> bool:
    """True for a uniform gas of equal spheres, without walls and gravity."""
    section = case.spheres
    alike = len(section.kinds) == 1 and section.kinds[0].spread == 0
    return alike and not case.walls and not section.gravity


def rate(case: Case, kT: float) -> float:
    """Collisions of a sphere per time in a uniform gas of equal hard spheres (Enskog)."""
    section, box = case.spheres, case.box
    kind, d = section.kinds[0], box.dimension
    return float(
        theory.enskog_rate(
            case.particles / box.volume,
            kind.diameter * section.scale(box),
            kT / kind.mean_mass(d),
            section.fraction(box),
            d,
        )
    )


def haff_time(case: Case, restitution: float, kT: float) -> float:
    """The time of Haff's law, from a temperature; infinite where energy is kept."""
    if restitution == 1:
        return math.inf
    return float(theory.haff_time(restitution, rate(case, kT), case.box.dimension))
