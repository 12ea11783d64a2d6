"""Theory of hard spheres in equilibrium: their pressure, and the collision rate that follows."""

import math
from functools import partial

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


def equal_hard(case: Case) -> bool:
    """True if all are hard spheres of one size, whose collision rate follows from the pressure."""
    section = case.spheres
    return len(section.kinds) == 1 and section.kinds[0].spread == 0 and section.collision.hard


def pair_rate(case: Case, root: float) -> float:
    """Collisions of a sphere per time in a uniform fluid of equal hard spheres, at a root of the
    temperature; nan of all others."""
    section, d = case.spheres, case.box.dimension
    if not equal_hard(case) or case.walls or section.gravity:
        return math.nan
    kind, phi = section.kinds[0], section.fraction(case.box)
    diameter = kind.diameter * section.scale(case.box)
    z = theory.compressibility_of_few(lambda x: theory.compressibility(x, d), phi, case.particles)
    excess = (z - 1) * speed_factor(case)
    return 2 * d * excess * root / (diameter * math.sqrt(math.pi * kind.mean_mass(d)))


def compressibility(case: Case) -> tuple[float, str, str]:
    """Z of hard spheres in a periodic box, the name of its law and a note; nan of other spheres.

    The note says so where the box is small, which changes the excess of Z by more than 0.2 %.
    """
    section, box, n = case.spheres, case.box, case.particles
    if not section.collision.hard:
        return math.nan, "", ""
    phi, plane = section.fraction(box), box.dimension == 2
    z, many = theory.compressibility_of_few(partial(_of_many, case), phi, n), _of_many(case, phi)
    note = fluid_note(case)
    if not note and abs(many - z) > 0.002 * abs(many - 1):
        note = f"approximate: {n} spheres; {many:.4g} is the law of many"
    if equal_hard(case):
        return z, "virial series" if plane else "Kolafa", note
    return z, "Santos, Yuste, Lopez de Haro" if plane else "Boublik, Mansoori et al.", note


def _of_many(case: Case, phi: float) -> float:
    """Z of many such spheres at a packing fraction."""
    section, box, d = case.spheres, case.box, case.box.dimension
    if equal_hard(case):
        return theory.compressibility(phi, d)
    counts, scale = section.counts(box), section.scale(box)
    kinds = list(zip(counts, section.kinds, strict=True))
    moments = [
        sum(n * kind.mean_power(p) * scale**p for n, kind in kinds) / sum(counts)
        for p in range(1, d + 1)
    ]
    return theory.mixture_compressibility(phi, moments, d)


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
