"""How often hard spheres collide, by the pressure that they have."""

import math

from mesokit import theory
from mesokit.case.case import Case

LAWS = {
    2: "virial series of the fluid, 1 % off at a packing fraction of 0.6 and more above",
    3: "Kolafa's equation of state of the fluid, which freezes at a packing fraction of 0.494",
}
TRUSTED = {2: 0.6, 3: 0.494}  # packing fraction above which theory is not that of the fluid


def fluid_note(case: Case) -> str:
    """Where the law of the fluid of hard spheres is not to be trusted; empty where it is."""
    far = case.spheres.fraction(case.box) > TRUSTED[case.box.dimension]
    return f"approximate: {LAWS[case.box.dimension]}; freezing is near" if far else ""


def pair_rate(case: Case, root: float) -> float:
    """Collisions of a sphere per time in a uniform fluid of equal hard spheres, at a root of the
    temperature; nan of all others."""
    section, d = case.spheres, case.box.dimension
    alike = len(section.kinds) == 1 and section.kinds[0].spread == 0
    if not (alike and section.collision.hard) or case.walls or section.gravity:
        return math.nan
    kind, phi = section.kinds[0], section.fraction(case.box)
    diameter = kind.diameter * section.scale(case.box)
    z = theory.compressibility_of_few(lambda x: theory.compressibility(x, d), phi, case.particles)
    excess = (z - 1) * speed_factor(case)
    return 2 * d * excess * root / (diameter * math.sqrt(math.pi * kind.mean_mass(d)))


def speed_factor(case: Case) -> float:
    """Mean relative speed over that of Maxwell's law: not 1 where the kinetic energy is fixed."""
    section = case.spheres
    alone = section.heating is None and section.collision.elastic and section.collision.hard
    if not alone or case.particles < 2:
        return 1.0
    return theory.mean_speed_factor(case.box.dimension * (case.particles - 1))


def root_of_temperature(case: Case, kinetic: float) -> float:
    """Root of the temperature of a kinetic energy; without walls momentum is zero."""
    degrees = case.box.dimension * max(case.particles - (0 if case.walls else 1), 1)
    return math.sqrt(2 * kinetic / degrees)
