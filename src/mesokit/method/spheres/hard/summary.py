"""Derived numbers of a case of event-driven dynamics, its cost, and warnings."""

import math
from collections.abc import Iterator
from typing import Any

from mesokit import theory
from mesokit.case.amounts import duration_text, number
from mesokit.case.case import Case
from mesokit.method.spheres.common import cost
from mesokit.method.spheres.common.checks import warnings_of_falls
from mesokit.method.spheres.common.start.lattice import LatticeStart
from mesokit.method.spheres.hard.checks import wall_contacts
from mesokit.method.spheres.hard.window import collision_rate
from mesokit.seam.method import Row, Summary

MADE_ELASTIC = 0.1  # share of the collisions beyond which a contact time changes the physics
FREEZES = {2: 0.70, 3: 0.494}  # packing fraction above which they order in equilibrium
DENSE, MELTS = 0.1, 50  # packing fraction from which a lattice lasts; collisions of each until then


def hard_summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, box = case.spheres, case.box
    steps, rate = case.run.warmup + case.run.steps, collision_rate(case)
    time, phi = steps * section.timestep, section.fraction(box)
    events = 0.5 * rate * case.particles * time
    flight = cost.flight_of(section, box)
    seconds = events * cost.COLLISION[box.dimension]
    if flight is not None:
        seconds = max(seconds, time * cost.hard_seconds(flight))
    hard = section.collision.hard
    enskog = "of a sphere at the start, Enskog" + ", without the potential" * (not hard)
    in_step = number(0.5 * rate * case.particles * section.timestep)
    rows: list[Row] = [
        ("collision rate", number(rate, "1/time"), enskog),
        ("collisions in a step", in_step, "of all"),
    ]
    if section.kT > 0 and len(section.kinds) == 1 and hard:
        z = theory.compressibility(phi, box.dimension)
        rows.append(("pressure", number(z, "n kT"), "in equilibrium without walls"))
    numbers: dict[str, Any] = {
        "packing_fraction": phi, "collision_rate": rate, "collisions": events, "seconds": seconds,
    }  # fmt: skip
    beside, note = _beside(case, flight, time, numbers), "estimate: one thread"
    return cost.summary_of(case, rows, beside, numbers, note, _warnings(case, rate))


def _beside(
    case: Case, flight: cost.Flight | None, time: float, numbers: dict[str, Any]
) -> Iterator[Row]:
    """Rows on the cost of the same spheres as soft ones, and on the cheaper method."""
    section = case.spheres
    if flight is None or not section.collision.hard:
        return
    contact, pair = cost.contact_time_as_hard(flight), section.collision
    step = contact / cost.STEPS
    soft = time / step * cost.soft_seconds(flight.number, flight.listed_by_soft, pair.rough)
    per_flight = 1 / (flight.rate * step)
    rests = cost.comes_to_rest(case, not pair.elastic, section.heating is not None)
    row = cost.cheaper("event-driven", soft / numbers["seconds"])
    numbers |= {
        "soft_seconds": soft,
        "soft_steps_per_flight": per_flight,
        "cheaper": "event-driven",
    }
    yield (
        "as soft spheres",
        duration_text(max(soft, 0.1)),
        f"a contact lasts {contact:.3g} and takes {cost.STEPS} steps, "
        f"a free flight {float(f'{per_flight:.3g}'):g}",
    )
    if rests:
        numbers["cheaper"], row = cost.cheaper_at_rest(case, time)
    yield row


def _warnings(case: Case, rate: float) -> Iterator[str]:
    section, box = case.spheres, case.box
    phi = section.fraction(box)
    contacts = wall_contacts(case)
    rough = ((contacts[:, 1] > -1) | (contacts[:, 3] > 0)).any()
    yield from warnings_of_falls(case, bool(rough))
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
    loses, contact_time = not section.collision.elastic, section.collision.contact_time
    if loses and contact_time == 0 and (phi > 0.1 or section.gravity):
        yield (
            "spheres.collision.contact_time: 0; where many inelastic collisions follow on one "
            "another the run ends in inelastic collapse"
        )
    share = theory.elastic_share(rate, contact_time)
    if loses and share > MADE_ELASTIC:
        yield (
            f"spheres.collision.contact_time: {contact_time:.3g} makes "
            f"{100 * share:.3g} % of the collisions elastic; expected less than a hundredth of the "
            f"mean free time, {1 / rate:.3g}"
        )
