"""Derived numbers of a case of event-driven dynamics, its cost, and warnings."""

import math
from collections.abc import Iterator
from typing import Any

from mesokit import theory
from mesokit.case.amounts import duration_text, number, size_text
from mesokit.case.case import Case
from mesokit.case.trajectory import stored_bytes
from mesokit.case.warnings import run_warnings
from mesokit.method.spheres.common import cost, falls
from mesokit.method.spheres.common.start.lattice import LatticeStart
from mesokit.method.spheres.hard.walls import wall_rows
from mesokit.method.spheres.hard.window import collision_rate
from mesokit.seam.method import Row, Summary

MADE_ELASTIC = 0.1  # share of the collisions beyond which a contact time changes the physics
FREEZES = {2: 0.70, 3: 0.494}  # packing fraction above which they order in equilibrium
DENSE, MELTS = 0.1, 50  # packing fraction from which a lattice lasts; collisions of each until then


def summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, box = case.spheres, case.box
    steps, rate = case.run.warmup + case.run.steps, collision_rate(case)
    time, phi = steps * section.timestep, section.fraction(box)
    events = 0.5 * rate * case.particles * time
    flight = cost.flight_of(section, box)
    seconds = events * cost.COLLISION[box.dimension]
    if flight is not None:
        seconds = max(seconds, time * cost.hard_seconds(flight))
    memory = case.particles * section.bytes_each + 200_000_000
    stored = stored_bytes(case.trajectory, case.groups, box.dimension, case.run.steps)
    hard = section.collision.hard
    enskog = "of a sphere at the start, Enskog" + ", without the potential" * (not hard)
    rows: list[Row] = [
        ("spheres", f"{case.particles:,}".replace(",", " "), ""),
        ("packing fraction", number(phi), ""),
        ("collision rate", number(rate, "1/time"), enskog),
        ("collisions in a step", number(0.5 * rate * case.particles * section.timestep), "of all"),
    ]
    if section.kT > 0 and len(section.kinds) == 1 and hard:
        z = theory.compressibility(phi, box.dimension)
        rows.append(("pressure", number(z, "n kT"), "in equilibrium without walls"))
    numbers: dict[str, Any] = {
        "packing_fraction": phi, "collision_rate": rate, "collisions": events, "seconds": seconds,
    }  # fmt: skip
    rows.append(("run time", duration_text(max(seconds, 0.1)), "estimate: one thread"))
    rows += _beside(case, flight, time, numbers)
    rows += [("memory", size_text(memory), "estimate")]
    if stored:
        rows.append(("trajectory", size_text(stored), "estimate"))
    warnings = (*run_warnings(case, memory, stored), *_warnings(case, rate))
    return Summary(tuple(rows), warnings, seconds, numbers, memory)


def _beside(
    case: Case, flight: cost.Flight | None, time: float, numbers: dict[str, Any]
) -> Iterator[Row]:
    """What the same spheres would cost as soft ones, and which method is cheaper."""
    section = case.spheres
    if flight is None or not section.collision.hard:
        return
    contact = cost.contact_time_as_hard(flight)
    step = contact / cost.STEPS
    rubs = section.collision.rough
    soft = time / step * cost.soft_seconds(flight.number, flight.listed_by_soft, rubs)
    per_flight = 1 / (flight.rate * step)
    loses, heated = not section.collision.elastic, section.heating is not None
    rests = cost.comes_to_rest(case, loses, heated)
    numbers |= {
        "soft_seconds": soft,
        "soft_steps_per_flight": per_flight,
        "cheaper": "soft-spheres" if rests else "event-driven",
    }
    yield (
        "as soft spheres",
        duration_text(max(soft, 0.1)),
        f"a contact lasts {contact:.3g} and takes {cost.STEPS} steps, "
        f"a free flight {float(f'{per_flight:.3g}'):g}",
    )
    if rests:
        yield cost.AT_REST
    else:
        yield cost.cheaper("event-driven", soft / numbers["seconds"])


def _warnings(case: Case, rate: float) -> Iterator[str]:
    section, box = case.spheres, case.box
    phi = section.fraction(box)
    contacts = wall_rows(case).contacts
    yield from falls.warnings(case, bool(((contacts[:, 1] > -1) | (contacts[:, 3] > 0)).any()))
    if phi > FREEZES[box.dimension]:
        ordered = isinstance(section.start, LatticeStart)
        slow = "a lattice stays ordered" if ordered else "a random start stays disordered"
        yield f"spheres: a packing fraction of {phi:.3g} freezes; {slow} for long"
    elif isinstance(section.start, LatticeStart) and case.observe and phi > DENSE:
        need = math.ceil(MELTS / (rate * section.timestep)) if rate > 0 else 0
        if case.run.warmup < need:
            yield (
                f"run.warmup = {case.run.warmup}: spheres start on a lattice, which lasts some "
                f"{MELTS} collisions of each, {need} steps"
            )
    loses = not section.collision.elastic
    if loses and section.collision.contact_time == 0 and (phi > 0.1 or section.gravity):
        yield (
            "spheres.collision.contact_time: 0; where many inelastic collisions follow on one "
            "another the run ends in inelastic collapse"
        )
    share = theory.elastic_share(rate, section.collision.contact_time)
    if loses and share > MADE_ELASTIC:
        yield (
            f"spheres.collision.contact_time: {section.collision.contact_time:.3g} makes "
            f"{100 * share:.3g} % of the collisions elastic; expected less than a hundredth of the "
            f"mean free time, {1 / rate:.3g}"
        )
