"""Derived numbers of a case of rigid grains, its cost, and warnings."""

import math
from collections.abc import Iterator
from typing import Any

from mesokit import theory
from mesokit.case.amounts import duration_text, number
from mesokit.case.case import Case
from mesokit.case.component import name_of, show
from mesokit.geometry import walls
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.surface import SurfaceContact
from mesokit.method.spheres.common import cost
from mesokit.method.spheres.common.checks import open_falls, rubs, warnings_of_falls
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.method.spheres.rigid import scales
from mesokit.processes.cores import usable_cores
from mesokit.seam.method import Row, Summary

FEWEST = 2000  # grains of a thread: with fewer, another thread gains nothing
FEW_SWEEPS = 5.0  # of a gas, whose contacts hardly depend on one another
NEAR = 3.0  # contacts near enough to close in a step, for each that closes
DENSE = 0.75  # of the packing fraction of a bed: from there on forces cross the packing
COARSE = 10  # steps in the fall by a diameter, below which paths and times are off
MOVED = 0.1  # diameters in a step at the usual speed, above which it is coarse
OFTEN = 0.02  # collisions of a grain in a step, above which bounces lose energy
YIELDS = 1e-3  # diameters by which a bed yields under its weight, from which it acts elastic


def rigid_summary(case: Case, threads: int | None = None) -> Summary:
    """Derived numbers, cost, and warnings."""
    section, steps = case.spheres, case.run.warmup + case.run.steps
    step, phi = scales.timestep_of(case), section.fraction(case.box)
    numbers: dict[str, Any] = {"packing_fraction": phi, "timestep": step}
    rows: list[Row] = [("timestep", number(step, "time"), scales.cause_of_step(case))]
    rows += _motion(case, numbers)
    rows += _contacts(case, numbers)
    in_step = _seconds_of_step(case, steps, numbers)
    cores = usable_cores() if threads is None else threads
    used = min(cores, most_threads(case))
    numbers["seconds"] = steps * in_step / used
    why = "few grains" if section.solver.shared else "contacts have one order"
    count, said = (used, "") if threads is None else (cores, f", no faster than {used}")
    few = f"{said}: {why}" if used < cores else ""
    note = f"estimate: {count} thread{'s' * (count > 1)}{few}"
    beside = list(_beside(case, steps, in_step, numbers))
    return cost.summary_of(case, rows, beside, numbers, note, _warnings(case, numbers))


def most_threads(case: Case) -> int:
    """The number of threads beyond which another one gains nothing."""
    return max(case.particles // FEWEST, 1) if case.spheres.solver.shared else 1


def _seconds_of_step(case: Case, steps: int, numbers: dict[str, Any]) -> float:
    """Mean seconds of a core for a step: all sweeps until grains are at rest, and then few."""
    grains, d, contacts = case.particles, case.box.dimension, numbers["contacts"]
    moving = cost.rigid_seconds(grains, contacts, numbers["sweeps"], d)
    driven = any(surface.moves for wall in case.walls for surface in wall.surfaces().values())
    if case.spheres.solver.tolerance == 0 or driven or not _rests(case):
        return moving
    resting = cost.rigid_seconds(grains, contacts, min(cost.LASTING, numbers["sweeps"]), d)
    part = cost.settling_part(case, max(steps, 1) * numbers["timestep"])
    return part * moving + (1 - part) * resting


def _rests(case: Case) -> bool:
    """Whether grains come to rest."""
    loses = case.spheres.turns or case.spheres.contact.restitution < 1
    return cost.comes_to_rest(case, loses, False)


def _motion(case: Case, numbers: dict[str, Any]) -> Iterator[Row]:
    """Rows on falls, friction and shear."""
    g, step, law = scales.strength_of_gravity(case), numbers["timestep"], case.spheres.contact
    if g > 0:
        steps = math.sqrt(2 * scales.mean_diameter(case) / g) / step
        numbers["steps_per_fall"] = steps
        yield "steps of a fall", number(steps), "by a diameter, from rest"
    if law.friction > 0:
        angle = math.degrees(math.atan(law.friction))
        yield "friction angle", number(angle, "degrees"), "of a block on a slope, atan(friction)"
    if case.box.sheared:
        strain = case.box.largest_rate * step
        yield "strain in a step", number(strain), "at the largest shear rate"
    inertial = inertial_number(case)
    if inertial is not None:
        numbers["inertial_number"] = inertial
        flow = "quasi-static" if inertial < 1e-3 else "dense flow" if inertial < 0.3 else "a gas"
        yield "inertial number", number(inertial), f"by the speed of plates: {flow}"


def inertial_number(case: Case) -> float | None:
    """Inertial number of grains between plates that move along themselves: under the pressure of a
    plate, or at half of the height under their weight; None where neither shears them."""
    box, d = case.box, case.box.dimension
    for wall in (wall for wall in case.walls if isinstance(wall, Plates)):
        k, faces = box.axes.index(wall.axis), list(wall.surfaces().values())
        speed = math.dist(*(face.velocity or (0.0,) * d for face in faces))
        area, length = box.volume / box.size[k], box.size[k]
        bed = cost.bed_of(case)
        deep = bed.number * ball_volume(d, bed.diameter) / (cost.AT_REST_FILLED[d] * area)
        pressure = max((_pressure(face.contact, area) for face in faces), default=0.0)
        falls = [abs(g) > 0 for g in case.spheres.gravity]
        if pressure == 0 and falls == [i == k for i in range(d)] and deep > DENSE * length:
            pressure, deep = 0.5 * bed.number * bed.mass * bed.gravity / area, length
        if speed > 0 and pressure > 0:
            density = bed.mass / ball_volume(d, bed.diameter)
            rate = speed / min(deep, length)
            return float(theory.inertial_number(rate, pressure, bed.diameter, density, d))
    return None


def _pressure(contact: SurfaceContact | None, area: float) -> float:
    """Pressure by which a plate is pushed into the box."""
    return 0.0 if contact is None else contact.pressure or (contact.force or 0.0) / area


def crowded(case: Case) -> bool:
    """Whether grains come to touch in chains: under gravity, pushed by a plate, or as dense as a
    bed."""
    section, filled = case.spheres, cost.AT_REST_FILLED[case.box.dimension]
    contacts = [surface.contact for _, surface, _ in walls.surfaces(case)]
    pushed = any(c is not None and (c.force or c.pressure or c.speed > 0) for c in contacts)
    dense = section.fraction(case.box) > DENSE * filled
    return bool(section.gravity) or pushed or dense


def _contacts(case: Case, numbers: dict[str, Any]) -> Iterator[Row]:
    """Rows on contacts and sweeps."""
    section, d, grains = case.spheres, case.box.dimension, case.particles
    solver = section.solver
    if not crowded(case):
        flight = cost.flight_of(section, case.box)
        rate = 0.0 if flight is None else flight.rate
        numbers["contacts"] = 0.5 * NEAR * grains * rate * numbers["timestep"]
        numbers["sweeps"] = min(FEW_SWEEPS, float(solver.sweeps))
        yield "contacts in a step", number(numbers["contacts"]), "that may close, by Enskog"
        return
    contacts, accuracy = cost.CONTACTS[d] * grains, solver.tolerance or cost.ACCURACY
    needed = cost.sweeps_in_bed(grains, d, min(accuracy, 0.5), solver.spreads)
    sweeps = float(solver.sweeps) if solver.tolerance == 0 else min(needed, solver.sweeps)
    numbers |= {"contacts": contacts, "sweeps_needed": needed, "sweeps": sweeps}
    if section.gravity:
        # a contact under the weight of a bed, of the stiffness that sweeps give a chain
        bed = cost.bed_of(case)
        chain = theory.rigid_chain(
            solver.sweeps, numbers["timestep"], bed.diameter, bed.mass, solver.spreads
        )
        weight = bed.mass * bed.gravity * bed.layers
        numbers["yields"] = weight / chain.stiffness / bed.diameter
    isostatic = theory.isostatic_coordination(d, section.contact.friction > 0)
    said = f"of grains at rest, those near enough included; isostatic: {isostatic:g} of a grain"
    yield "contacts", number(contacts), said
    yield (
        "sweeps needed",
        number(needed),
        f"for all forces anew, to {accuracy:g}; fewer where these last from step to step",
    )


def _beside(case: Case, steps: int, seconds: float, numbers: dict[str, Any]) -> Iterator[Row]:
    """Rows on the cost of the same grains by other methods, and on the cheapest one; seconds: of a
    step."""
    section, time = case.spheres, max(steps, 1) * numbers["timestep"]
    costs = {"contact-dynamics": max(steps, 1) * seconds}
    rests, flight = _rests(case), cost.flight_of(section, case.box)
    if section.gravity:
        bed = cost.bed_of(case)
        stiffness, per_time = bed.stiffness_as_hard, seconds / numbers["timestep"]
        costs["soft-spheres"] = soft = time * bed.seconds_of_soft(stiffness)
        equal = bed.stiffness_of_equal_cost(per_time)
        numbers |= {"soft_seconds": soft, "stiffness": stiffness, "equal_stiffness": equal}
        under = f"an overlap of {cost.UNDER_WEIGHT:g} diameters under the weight"
        yield (
            "as soft spheres",
            duration_text(max(soft, 0.1)),
            f"estimate: of a stiffness of {float(f'{stiffness:.3g}'):g}, {under}",
        )
        yield (
            "equal cost",
            number(equal, "mass/time^2"),
            "stiffness from which soft spheres take longer",
        )
    if flight is not None and not rests:
        costs["event-driven"] = hard = time * cost.hard_seconds(flight)
        numbers["hard_seconds"] = hard
        yield (
            "as hard spheres",
            duration_text(max(hard, 0.1)),
            "estimate: event-driven, while they fly as at first",
        )
    if len(costs) < 2:
        return
    best, *others = sorted(costs, key=lambda name: costs[name])
    numbers["cheaper"] = best
    other = "contact-dynamics" if best != "contact-dynamics" else others[0]
    yield cost.cheaper(cost.NAMES[best], costs[other] / costs[best])


def _warnings(case: Case, numbers: dict[str, Any]) -> Iterator[str]:
    section, law = case.spheres, case.spheres.contact
    yield from warnings_of_falls(case, law.friction > 0 or rubs(case))
    yield from _of_step(case, numbers)
    yield from _of_walls(case, (case.run.warmup + case.run.steps) * numbers["timestep"])
    solver, yields = section.solver, numbers.get("yields", 0.0)
    if yields > YIELDS:
        yield (
            f"spheres.solver.sweeps = {solver.sweeps}: too few for so many grains; a bed yields by "
            f"{yields:.2g} diameters while forces change, as if grains were elastic"
        )
    if solver.tolerance == 0:
        yield (
            f"spheres.solver.tolerance = 0: each step has all {solver.sweeps} sweeps, whether or "
            "not forces still change"
        )
    if not solver.settles and crowded(case):
        yield (
            f"spheres.solver.rule = {show(name_of(solver))}: errors of forces grow from sweep to "
            "sweep in dense packings; expected a smaller relaxation, or rule 'gauss-seidel'"
        )
    bounces = max(scales.restitutions(case))
    flight = cost.flight_of(section, case.box)
    often = 0.0 if flight is None else flight.rate * numbers["timestep"]
    if bounces > 0 and often > OFTEN:
        yield (
            f"spheres.timestep = {numbers['timestep']:.3g}: a grain collides {often:.2g} times in "
            "a step; bounces of several at once take energy that restitution would leave them"
        )
    if bounces > 0 and crowded(case):
        yield (
            f"spheres.contact.restitution = {bounces:g}: right for contacts of two; grains that "
            "touch in a chain do not pass a blow on to the last one"
        )


def _of_walls(case: Case, end: float) -> Iterator[str]:
    """Warnings of plates that leave grains no room, and of walls that open above nothing, before
    the end of the run."""
    left, moved = [float(length) for length in case.box.size], None
    for key, surface, wall in walls.surfaces(case):
        contact = surface.contact
        if contact is not None and contact.speed != 0:
            far = min(abs(contact.speed) * end, contact.travel or math.inf)
            left[case.box.index(wall.axis)] -= math.copysign(far, contact.speed)
            moved = key if contact.speed > 0 else moved
    room, d = math.prod(max(length, 0.0) for length in left), case.box.dimension
    filled = case.spheres.fraction(case.box) * case.box.volume / room if room > 0 else math.inf
    if moved is not None and filled > scales.CLOSEST[d]:
        packing = f"a packing fraction of {filled:.2g}" if room > 0 else "none"
        yield (
            f"{moved}.contact.speed: plates leave grains too little room at the end of the run, "
            f"{packing}; expected a smaller {moved}.contact.travel"
        )
    for i, wall in enumerate(case.walls):
        if wall.opens is not None and wall.opens >= end:
            yield f"wall[#{i + 1}].opens = {wall.opens:g}: the run ends before, at {end:g}"
        elif wall.opens is not None:
            before = open_falls(case)
            for axis in (axis for axis in open_falls(case, wall.opens) if axis not in before):
                yield (
                    f"wall[#{i + 1}].opens = {wall.opens:g}: nothing ends the fall along {axis} "
                    "afterwards, and the run ends where grains are too fast; expected a wall below"
                )


def _of_step(case: Case, numbers: dict[str, Any]) -> Iterator[str]:
    """Warnings of steps too long for paths, and for the fastest grains there may be."""
    step, diameter = numbers["timestep"], scales.mean_diameter(case)
    fall, moved = numbers.get("steps_per_fall", math.inf), scales.usual_speed(case) * step
    if fall < COARSE:
        yield (
            f"spheres.timestep = {step:.3g}: a fall by a diameter takes {fall:.3g} steps; expected "
            f"at least {COARSE}"
        )
    if moved > MOVED * diameter:
        yield (
            f"spheres.timestep = {step:.3g}: grains move by {moved / diameter:.2g} diameters in a "
            f"step; expected at most {MOVED:g}"
        )
    longest = scales.longest_step(case, scales.largest_speed(case))
    if step > longest:
        yield (
            f"spheres.timestep = {step:.3g}: the run ends where a grain falls through the whole "
            f"box; expected less than {longest:.3g}, or a larger spheres.skin"
        )
