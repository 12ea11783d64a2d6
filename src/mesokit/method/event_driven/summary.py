"""Derived numbers of a case of event-driven dynamics, its cost, and warnings."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from mesokit import theory
from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.method.event_driven.window import collision_rate
from mesokit.method.protocol import Row, Summary

if TYPE_CHECKING:
    from mesokit.case.case import Case

RATE = 0.5e6  # collisions per second, where the project measures (docs/benchmark.md)
BYTES = 350  # for each sphere: states, lists, queue
FREEZES = {2: 0.70, 3: 0.494}  # packing fraction above which they order in equilibrium


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, box = case.spheres, case.box
    steps, rate = case.run.warmup + case.run.steps, collision_rate(case)
    time, phi = steps * section.timestep, section.fraction(box)
    events = 0.5 * rate * case.particles * time
    seconds = events / RATE
    memory = case.particles * BYTES + 200_000_000
    stored = stored_bytes(case.trajectory, case.groups, box.dimension, case.run.steps)
    rows: list[Row] = [
        ("spheres", f"{case.particles:,}".replace(",", " "), ""),
        ("packing fraction", number(phi), ""),
        ("collision rate", number(rate, "1/time"), "of a sphere at the start, Enskog"),
        ("collisions in a step", number(0.5 * rate * case.particles * section.timestep), "of all"),
    ]
    if section.kT > 0 and len(section.kinds) == 1:
        z = theory.compressibility(phi, box.dimension)
        rows.append(("pressure", number(z, "n kT"), "in equilibrium without walls"))
    rows += [
        ("run time", duration_text(seconds), "estimate: one thread"),
        ("memory", size_text(memory), "estimate"),
    ]
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    numbers = {"packing_fraction": phi, "collision_rate": rate, "collisions": events}
    warnings = (*run_warnings(case, memory, stored), *_warnings(case))
    return Summary(tuple(rows), warnings, seconds, numbers)


def _warnings(case: Case) -> Iterator[str]:
    section, box = case.spheres, case.box
    phi = section.fraction(box)
    if phi > FREEZES[box.dimension]:
        yield f"spheres: a packing fraction of {phi:.3g} freezes; a lattice stays ordered for long"
    loses = not section.collision.elastic
    if loses and section.collision.contact_time == 0 and (phi > 0.1 or section.gravity):
        yield (
            "spheres.collision.contact_time: 0; where many inelastic collisions follow on one "
            "another the run ends in inelastic collapse"
        )
