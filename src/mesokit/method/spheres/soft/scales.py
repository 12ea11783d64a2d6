"""Times and speeds of a case of soft spheres: collisions, contacts and steps."""

import math
from collections.abc import Callable

from mesokit.case.case import Case
from mesokit.geometry.walls import surfaces
from mesokit.method.spheres.soft.pair.protocol import ContactLaw

IN_CONTACT, WARNED, REFUSED = 50, 20, 10  # steps in a contact: usual, and fewest without complaint
OF_FLIGHT = 0.005  # of the time in which a sphere of a fluid flies its diameter
FASTEST = 3.0  # thermal velocities of two that collide, hardly more
EXTREME = 100.0  # decades of speeds on both sides of 1
ROUNDING = 1e-9  # of a step: a contact of just ten steps is followed


def lightest(case: Case) -> float:
    """The smallest mass."""
    d = case.box.dimension
    return min(kind.mean_mass(d) * (1 - kind.spread) ** d for kind in case.spheres.kinds)


def speed_of_collision(case: Case) -> float:
    """The largest relative speed of collisions: `spheres.speed`; or of thermal motion or a fall
    through the box, plus the speed of walls."""
    section = case.spheres
    if section.speed is not None:
        return float(section.speed)
    return max(speed_of_heat(case, section.kT), speed_of_fall(case)) + speed_of_walls(case)


def speed_of_heat(case: Case, kT: float) -> float:
    """The relative speed of thermal motion, of this energy or of a bath."""
    bath = case.spheres.thermostat
    return FASTEST * math.sqrt(max(kT, 0.0 if bath is None else bath.held_kT) / lightest(case))


def speed_of_fall(case: Case) -> float:
    """The speed after a fall through the box."""
    pulls = zip(case.spheres.gravity, case.box.size, strict=False)
    return math.sqrt(2 * sum(abs(g) * length for g, length in pulls))


def speed_of_walls(case: Case) -> float:
    """The largest speed that a wall gives to a sphere at rest."""
    farthest, speeds = 0.5 * math.hypot(*case.box.size), [0.0]  # from the axis of a wall that turns
    for _, surface, _ in surfaces(case):
        turning, contact = surface.rotation or 0.0, surface.contact
        rate = math.hypot(*(turning if isinstance(turning, tuple) else (turning,)))
        # A sphere at rest gets twice the speed of a plate that hits it.
        struck = 0.0 if contact is None else 2 * contact.amplitude * contact.frequency
        struck += 0.0 if contact is None else 2 * abs(contact.speed)
        speeds.append(math.hypot(*(surface.velocity or (0.0,))) + rate * farthest + struck)
    return max(speeds)


def shortest_contact(case: Case) -> float:
    """The shortest time that a contact takes; infinite for spheres that never meet."""
    law = case.spheres.pair
    assert isinstance(law, ContactLaw)
    return law.contact_time_of(0.5 * lightest(case), speed_of_collision(case))


def timestep_of(case: Case) -> float:
    """Time of a step."""
    given = case.spheres.timestep
    return usual_timestep(case) if given is None else float(given)


def usual_timestep(case: Case) -> float:
    """Time of a step without `spheres.timestep`."""
    law = case.spheres.pair
    if isinstance(law, ContactLaw):
        time = shortest_contact(case)
        return time / IN_CONTACT if math.isfinite(time) else OF_FLIGHT
    return step_of_flight(case, expected_kT(case))


def expected_kT(case: Case) -> float:
    """The largest of kT, that of the bath and 1: for the step with a potential."""
    bath = case.spheres.thermostat
    return max(case.spheres.kT, bath.held_kT if bath else 0.0, 1.0)


def step_of_flight(case: Case, kT: float) -> float:
    """A part of the time in which a sphere flies its diameter."""
    law = case.spheres.pair
    return float(OF_FLIGHT * law.diameter * math.sqrt(lightest(case) / kT))


def fastest_followed(case: Case) -> float:
    """The speed at which a contact takes ten steps; infinite where the speed does not matter."""
    law, mass, step = case.spheres.pair, 0.5 * lightest(case), timestep_of(case)
    if not isinstance(law, ContactLaw):
        return math.inf
    least = REFUSED * step * (1 - ROUNDING)
    return _least_speed(lambda speed: law.contact_time_of(mass, speed) < least)


def speed_of_overlap(case: Case, overlap: float) -> float:
    """The relative speed of a collision with this largest overlap: a bound of the speed at which
    two spheres with this overlap part."""
    law, mass = case.spheres.pair, 0.5 * lightest(case)
    assert isinstance(law, ContactLaw)
    return _least_speed(lambda speed: law.overlap_of(mass, speed) >= overlap)


def _least_speed(holds: Callable[[float], bool]) -> float:
    """The least speed for which a monotonic condition holds, by bisection; infinite if for none."""
    low, high = -EXTREME, EXTREME
    if not holds(10.0**high):
        return math.inf
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(10.0**middle) else (middle, high)
    return float(10.0**high)
