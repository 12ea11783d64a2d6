"""The length of a window, the time after which all spheres are brought to one time."""

import math

from mesokit import theory
from mesokit.case.case import Case

COLLISIONS = 500.0  # of each sphere in a window, about
INSTANT = 1e-12  # of the mean time between two collisions
BETWEEN_TURNS = 0.25  # collisions of a sphere
FLIGHT_BINS, LONGEST_FLIGHT = 256, 8.0  # number; mean times between collisions
LONGEST, SHORTEST = 2.0**60, 2.0**-60


def thermal_rate(case: Case) -> float:
    """Collisions of a sphere per time by its thermal motion, estimated (Enskog; kinds as one; or
    across the box); 0 at rest."""
    section, box = case.spheres, case.box
    if section.kT == 0:
        return 0.0
    mass = min(kind.mean_mass(box.dimension) for kind in section.kinds)
    phi, number = min(section.fraction(box), 0.7), section.count(box)
    density, kT_over_m = number / box.volume, section.kT / mass
    rate = theory.enskog_rate(density, _diameter(case), kT_over_m, phi, box.dimension)
    return max(rate, math.sqrt(section.kT / mass) / max(box.size))


def collision_rate(case: Case) -> float:
    """Collisions of a sphere per time at the start, estimated; or, where that is more, the inverse
    time to fall by a diameter."""
    gravity = case.spheres.gravity
    fall = math.sqrt(math.hypot(*gravity) / _diameter(case)) if gravity else 0.0
    return max(thermal_rate(case), fall)


def _diameter(case: Case) -> float:
    """The largest."""
    return max(kind.diameter for kind in case.spheres.kinds) * case.spheres.scale(case.box)


def window(case: Case) -> float:
    """The length of a window: a power of two, about 500 mean times between collisions, or a quarter
    of one with heating. It does not depend on the timestep, which so changes no bit."""
    rate, heating = collision_rate(case), case.spheres.heating
    if heating is not None and heating.interval is not None:
        return float(heating.interval)
    if rate == 0.0:
        return 1024.0
    wanted = 2.0 ** round(math.log2((COLLISIONS if heating is None else BETWEEN_TURNS) / rate))
    return min(max(wanted, SHORTEST), LONGEST)


def instant(case: Case) -> float:
    """A time between two collisions that counts as none, for the detection of collapse."""
    rate = collision_rate(case)
    return INSTANT / rate if rate > 0 else 0.0


def flight_bins(case: Case) -> tuple[float, int]:
    """Width and number of the bins of times between collisions: eight times the mean, about."""
    mean = 1 / (thermal_rate(case) or collision_rate(case) or 1.0)
    return LONGEST_FLIGHT * mean / FLIGHT_BINS, FLIGHT_BINS
