"""Derived numbers of a case of soft spheres, its cost, and warnings."""

import math
from collections.abc import Iterator
from typing import Any

from mesokit.case.amounts import duration_text, number
from mesokit.case.case import Case
from mesokit.method.spheres.common import cost
from mesokit.method.spheres.common.checks import rubs, warnings_of_falls
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.method.spheres.soft import scales
from mesokit.method.spheres.soft.pair.protocol import ContactLaw
from mesokit.processes.cores import usable_cores
from mesokit.seam.method import Row, Summary

RATE_OF_POTENTIALS = 2.5e6  # sphere-steps per second and core (docs/benchmark)
USUAL_NEIGHBOURS = 66.0  # of a sphere, within the reach, where that rate was measured
FEWEST = 500  # spheres of a thread: with fewer, another thread gains nothing
DEEP = 0.05  # overlap, in diameters, beyond which spheres are not hard
LONG = 4.0  # usual timesteps: a longer one makes the energy of a fluid with a potential drift


def soft_summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, box = case.spheres, case.box
    cores = usable_cores() if threads is None else threads
    steps, step = case.run.warmup + case.run.steps, scales.timestep_of(case)
    phi = section.fraction(box)
    rows = [("timestep", number(step, "time"), "" if section.timestep else "unless said")]
    numbers: dict[str, Any] = {"packing_fraction": phi, "timestep": step}
    reach, density = section.reach(box), case.particles / box.volume
    if isinstance(section.pair, ContactLaw):
        rows += _contacts(case, numbers)  # both lists of rows add to `numbers`, for warnings
        # Grains at rest are closer than those that fall, so their lists are longer.
        rests = cost.comes_to_rest(case, _loses(case), section.thermostat is not None)
        closer = max(phi, cost.AT_REST_FILLED[box.dimension]) / phi if rests else 1.0
        listed = closer * density * ball_volume(box.dimension, 2 * cost.LIST_REACH * reach)
        core_seconds = steps * cost.soft_seconds(case.particles, listed, section.turns)
    else:
        within = density * ball_volume(box.dimension, 2 * reach)
        rate = RATE_OF_POTENTIALS * USUAL_NEIGHBOURS / max(within, 10.0)
        core_seconds = steps * case.particles / rate
    used = min(cores, max(case.particles // FEWEST, 1))
    numbers["seconds"] = core_seconds / used
    few = f", no faster than {used}: few spheres" if used < cores else ""
    note = f"estimate: {cores} thread{'s' * (cores > 1)}{few}"
    beside = list(_beside(case, steps, core_seconds, numbers))
    return cost.summary_of(case, rows, beside, numbers, note, _warnings(case, numbers))


def _contacts(case: Case, numbers: dict[str, Any]) -> Iterator[Row]:
    """Rows on the duration and overlap of contacts, where anything moves."""
    section, speed = case.spheres, scales.speed_of_collision(case)
    time, mass = scales.shortest_contact(case), 0.5 * scales.lightest(case)
    if math.isfinite(time):
        numbers |= {"contact_time": time, "steps_per_contact": time / numbers["timestep"]}
        yield "contact time", number(time, "time"), "of the lightest two"
        yield "steps per contact", number(numbers["steps_per_contact"]), ""
    if speed == 0:
        yield "collision speed", "0", "nothing moves: kT, gravity and walls are without motion"
        return
    numbers["overlap"] = overlap = section.pair.overlap_of(mass, speed) / section.reach(case.box)
    said = "thermal, or after a fall through the box, and of walls that move"
    note = said if section.speed is None else "spheres.speed"
    yield "collision speed", number(speed, "length/time"), note
    yield "overlap", number(overlap, "diameters"), "expected at that speed"


def _beside(case: Case, steps: int, core_seconds: float, numbers: dict[str, Any]) -> Iterator[Row]:
    """Rows on the cost of the same spheres as hard ones, and on the cheaper method."""
    section, time = case.spheres, steps * numbers["timestep"]
    if not isinstance(section.pair, ContactLaw):
        return
    flight = cost.flight_of(section, case.box)
    if flight is not None:
        per_flight, hard = 1 / (flight.rate * numbers["timestep"]), time * cost.hard_seconds(flight)
        numbers |= {"hard_seconds": hard, "steps_per_flight": per_flight}
        yield "steps per flight", number(per_flight), "from a collision to the next"
        yield (
            "as hard spheres",
            duration_text(max(hard, 0.1)),
            "estimate: event-driven, while they fly as at first",
        )
    if cost.comes_to_rest(case, _loses(case), section.thermostat is not None):
        numbers["cheaper"], row = cost.cheaper_at_rest(case, time, core_seconds)
        yield row
    elif flight is not None:
        name = "soft-spheres" if core_seconds < hard else "event-driven"
        numbers["cheaper"] = name
        more, less = max(hard, core_seconds), min(hard, core_seconds)
        yield cost.cheaper(cost.NAMES[name], more / less if less else 1.0)


def _loses(case: Case) -> bool:
    """True if contacts dissipate energy."""
    mass, speed = 0.5 * scales.lightest(case), scales.speed_of_collision(case)
    return case.spheres.turns or case.spheres.pair.restitution_of(mass, speed) < 1


def _warnings(case: Case, numbers: dict[str, float]) -> Iterator[str]:
    section, touching = case.spheres, isinstance(case.spheres.pair, ContactLaw)
    yield from warnings_of_falls(case, touching and (section.pair.friction > 0 or rubs(case)))
    usual = scales.usual_timestep(case)
    if not touching and numbers["timestep"] > LONG * usual:
        yield (
            f"spheres.timestep = {numbers['timestep']:.3g}: energy drifts, or the run breaks down; "
            f"expected some {usual:.3g}"
        )
    per_contact = numbers.get("steps_per_contact", math.inf)
    if per_contact < scales.WARNED:
        yield (
            f"spheres.timestep: {per_contact:.3g} steps in a contact; restitution and energy are "
            "off by a percent or more below 20"
        )
    if numbers.get("overlap", 0.0) > DEEP:
        yield (
            f"spheres.pair: spheres overlap by {numbers['overlap']:.2g} diameters where they "
            "collide; hard ones ask for a shorter contact time or a larger stiffness"
        )
