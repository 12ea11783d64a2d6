"""Times and speeds of a case of rigid grains."""

import math

from mesokit.case.case import Case
from mesokit.geometry.walls import surfaces

OF_FALL = 0.01  # of the time in which a grain falls by its diameter
OF_FLIGHT = 0.02  # diameters that a grain moves in a step
FASTEST = 3.0  # thermal velocities, hardly more


def mean_diameter(case: Case) -> float:
    """Mean diameter of all grains."""
    section, box = case.spheres, case.box
    counts, total = section.counts(box), section.count(box)
    pairs = zip(counts, section.kinds, strict=True)
    return sum(n * kind.mean_power(1) for n, kind in pairs) / total * section.scale(box)


def heaviest(case: Case) -> float:
    """The largest mass."""
    d = case.box.dimension
    return max(kind.mean_mass(d) * (1 + kind.spread) ** d for kind in case.spheres.kinds)


def strength_of_gravity(case: Case) -> float:
    """Size of the acceleration of gravity."""
    return math.hypot(*case.spheres.gravity)


def speed_of_walls(case: Case) -> float:
    """The largest speed of a wall."""
    farthest, speeds = 0.5 * math.hypot(*case.box.size), [0.0]  # from the axis of a wall that turns
    for _, surface, _ in surfaces(case):
        turning, contact = surface.rotation or 0.0, surface.contact
        rate = math.hypot(*(turning if isinstance(turning, tuple) else (turning,)))
        shaken = 0.0 if contact is None else contact.amplitude * contact.frequency
        shaken += 0.0 if contact is None else abs(contact.speed)
        speeds.append(math.hypot(*(surface.velocity or (0.0,))) + rate * farthest + shaken)
    return max(speeds)


def usual_speed(case: Case) -> float:
    """The largest of thermal speeds, those of walls and those of shear."""
    section, d = case.spheres, case.box.dimension
    lightest = min(kind.mean_mass(d) * (1 - kind.spread) ** d for kind in section.kinds)
    shear = case.box.largest_rate * case.box.size[1] if d > 1 else 0.0
    return max(FASTEST * math.sqrt(section.kT / lightest), speed_of_walls(case), shear)


def largest_speed(case: Case) -> float:
    """A speed that grains hardly exceed: that of a fall through the box, or the usual one."""
    pulls = zip(case.spheres.gravity, case.box.size, strict=False)
    fall = math.sqrt(2 * sum(abs(g) * length for g, length in pulls))
    return max(fall, usual_speed(case))


def timestep_of(case: Case) -> float:
    """Time of a step."""
    if case.spheres.timestep is not None:
        return float(case.spheres.timestep)
    diameter, g, speed = mean_diameter(case), strength_of_gravity(case), usual_speed(case)
    fall = OF_FALL * math.sqrt(2 * diameter / g) if g > 0 else math.inf
    flight = OF_FLIGHT * diameter / speed if speed > 0 else math.inf
    step = min(fall, flight)
    return step if math.isfinite(step) else OF_FLIGHT
