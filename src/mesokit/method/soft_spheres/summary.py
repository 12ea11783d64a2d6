"""Derived numbers of a case of soft spheres, its cost, and warnings."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.method.protocol import Row, Summary
from mesokit.method.soft_spheres import scales
from mesokit.method.soft_spheres.pair.protocol import ContactLaw
from mesokit.running.cores import usable_cores

if TYPE_CHECKING:
    from mesokit.case.case import Case

RATE_OF_CONTACTS, RATE_OF_POTENTIALS = (
    6e6,
    2.5e6,
)  # sphere-steps per second and core (docs/benchmark)
USUAL_NEIGHBOURS = 66.0  # within the reach, where the second was measured
BYTES = 600  # for each sphere: states twice, lists
DEEP = 0.05  # overlap, in diameters, beyond which spheres are not hard


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, box = case.spheres, case.box
    cores = usable_cores() if threads is None else threads
    steps, step = case.run.warmup + case.run.steps, scales.timestep_of(section, box)
    phi = section.fraction(box)
    memory = case.particles * BYTES + 200_000_000
    stored = stored_bytes(case.trajectory, case.groups, box.dimension, case.run.steps)
    rows: list[Row] = [
        ("spheres", f"{case.particles:,}".replace(",", " "), ""),
        ("packing fraction", number(phi), ""),
        ("timestep", number(step, "time"), "" if section.timestep else "unless said"),
    ]
    numbers = {"packing_fraction": phi, "timestep": step}
    rate = RATE_OF_POTENTIALS
    if isinstance(section.pair, ContactLaw):
        rate, speed = RATE_OF_CONTACTS, scales.speed_of_collision(section, box)
        time, mass = scales.shortest_contact(section, box), 0.5 * scales.lightest(section, box)
        overlap = section.pair.overlap_of(mass, speed) / section.reach(box)
        numbers |= {"contact_time": time, "steps_per_contact": time / step, "overlap": overlap}
        rows += [
            ("contact time", number(time, "time"), "of the lightest two"),
            ("steps per contact", number(time / step), ""),
            (
                "collision speed",
                number(speed, "a/time"),
                "thermal, or after a fall through the box",
            ),
            ("overlap", number(overlap, "diameters"), "expected at that speed"),
        ]
    else:
        within = case.particles / box.volume * _ball(box.dimension, section.reach(box))
        rate *= USUAL_NEIGHBOURS / max(within, 10.0)
    seconds = steps * case.particles / (rate * min(cores, max(case.particles // 500, 1)))
    rows += [
        ("run time", duration_text(seconds), f"estimate: {cores} threads"),
        ("memory", size_text(memory), "estimate"),
    ]
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    warnings = (*run_warnings(case, memory, stored), *_warnings(case, numbers))
    return Summary(tuple(rows), warnings, seconds, numbers)


def _ball(dimension: int, radius: float) -> float:
    return math.pi * radius**2 if dimension == 2 else 4 / 3 * math.pi * radius**3


def _warnings(case: Case, numbers: dict[str, float]) -> Iterator[str]:
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
