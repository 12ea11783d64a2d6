"""Times and speeds of a case of rigid grains."""

import math

from mesokit.case.case import Case
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.walls import surfaces

OF_FALL = 0.01  # of the time in which a grain falls by its diameter
OF_FLIGHT = 0.02  # diameters that a grain moves in a step
OF_SKIN = 0.8  # of the step in which the fastest grain passes the skin
OF_PERIOD = 0.02  # of the period of a vibration
FASTEST = 3.0  # thermal velocities, hardly more
CLOSEST = {2: math.pi / math.sqrt(12), 3: math.pi / math.sqrt(18)}  # packing of equal grains


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


def closing_speed(case: Case) -> float:
    """The largest speed of a wall along its normal, of those that are not pushed."""
    found = [0.0]
    for _, surface, _ in surfaces(case):
        if (contact := surface.contact) is not None:
            found.append(contact.amplitude * contact.frequency + abs(contact.speed))
    return max(found)


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


def restitutions(case: Case) -> list[float]:
    """Restitution of grains, and of the surfaces of walls that have one of their own."""
    contacts = [surface.contact for _, surface, _ in surfaces(case)]
    own = [c.restitution for c in contacts if c is not None and c.restitution is not None]
    return [case.spheres.contact.restitution, *own]


def skin_of(case: Case) -> float:
    """Length of neighbour lists beyond contact."""
    return float(case.spheres.skin_of(case.box, closed_axes(case.walls)))


def longest_step(case: Case, speed: float) -> float:
    """The time of a step in which two grains of a speed come as near as the skin is long.

    The engine takes twice the speed at the end of a step, more if they bounce, and the range of
    cohesion off (`reach_of_step`).
    """
    cohesion, g = case.spheres.contact.cohesion, strength_of_gravity(case)
    within = 0.0 if cohesion is None else cohesion.range
    free = max(skin_of(case) - within, 0.0) / (2 * (1 + max(restitutions(case))))
    speed += speed_of_walls(case)
    # speed * step + g * step^2 = free, without a difference of large numbers
    sum_of = speed + math.sqrt(speed * speed + 4 * g * free)
    return 2 * free / sum_of if sum_of > 0 else math.inf


def shortest_period(case: Case) -> float:
    """The shortest period of a plate that vibrates; infinite without one."""
    contacts = [surface.contact for _, surface, _ in surfaces(case)]
    rates = [c.frequency for c in contacts if c is not None and c.amplitude * c.frequency > 0]
    return 2 * math.pi / max(rates) if rates else math.inf


def steps_by_cause(case: Case) -> dict[str, float]:
    """Largest times of a step, unless `timestep` is given, by what they follow from."""
    diameter, g, speed = mean_diameter(case), strength_of_gravity(case), usual_speed(case)
    fall = OF_FALL * math.sqrt(2 * diameter / g) if g > 0 else math.inf
    flight = OF_FLIGHT * diameter / speed if speed > 0 else math.inf
    return {
        "a hundredth of the fall by a diameter": fall,
        "a fiftieth of the flight of a diameter": flight,
        "no grain that falls through the box passes another": OF_SKIN
        * longest_step(case, largest_speed(case)),
        "a fiftieth of the shortest vibration": OF_PERIOD * shortest_period(case),
    }


def timestep_of(case: Case) -> float:
    """Time of a step."""
    if case.spheres.timestep is not None:
        return float(case.spheres.timestep)
    step = min(steps_by_cause(case).values())
    return step if math.isfinite(step) else OF_FLIGHT


def cause_of_step(case: Case) -> str:
    """What the time of a step follows from; nothing where it is given."""
    if case.spheres.timestep is not None:
        return ""
    causes = steps_by_cause(case)
    cause = min(causes, key=lambda name: causes[name])
    return cause if math.isfinite(causes[cause]) else "nothing moves"
