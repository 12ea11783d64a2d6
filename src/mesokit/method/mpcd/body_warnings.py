"""Warnings of bodies that move: cases that can run, and may not give what was meant."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import name_of, one_of, show
from mesokit.case.describe.digits import above
from mesokit.case.registry import family_of
from mesokit.method.mpcd.body.inertia import hidden_parts, separate_pieces
from mesokit.method.mpcd.body.protocol import named
from mesokit.method.mpcd.checks.bodies import THIN_BODY
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.bodies import followed
from mesokit.method.mpcd.numbers import Derived

FAST_BODY = 0.2  # speeds of sound
SWING = 0.5  # radians of a trap in a timestep; at 2 the velocity is 1.3 times as hot
HEAVY = 10.0  # masses of the displaced fluid
INERTIAL = 1.0  # Reynolds number of the speed and the radius
INERTIAL_PAIR = {2: 0.05, 3: 0.5}  # U d/nu of a dumbbell: a tenth of its speed
HOT_GAPS = 0.03  # kT a step: disks with 0.1 were 2.6 +- 1.4 % too hot, a run with 0.2 stopped
LONG_STRIDE = 0.25  # radii that a body flies in a timestep


def body_warnings(case: Case, numbers: Derived) -> Iterator[str]:
    """Of each kind of bodies, and of all together."""
    fluid, d = case.fluid, case.box.dimension
    density = fluid.density * fluid.mass
    for i, kind in enumerate(case.bodies, start=1):
        key, solid, mass = f"bodies[#{i}]", kind.solid(d), kind.mass_in(d, density)
        if solid.overlaps:
            yield f"{key}.parts: some overlap, so its volume and inertia are sampled on a grid"
        more = ", but repels by gaps of its own" * (kind.interaction.depth > 0)
        for part, other in hidden_parts(solid, d):
            yield (
                f"{key}.parts[#{part + 1}]: wholly inside parts[#{other + 1}], so that it adds "
                f"nothing to shape and mass{more}; leave it out"
            )
        if (apart := separate_pieces(solid, d)) > 1:
            yield (
                f"{key}.parts: they lie apart, in {apart} pieces, which move as one body with "
                "fluid between them"
            )
        yield from (f"{key}.{note}" for note in _idle(case, kind))
        yield from (f"{key}.{note}" for note in _beside_the_line(kind))
        yield from (f"{key}.{note}" for note in _trap_at_wall(case, kind))
        swing = math.sqrt(kind.trap.k * fluid.kT / mass) * fluid.timestep if kind.trap else 0.0
        if above(swing, SWING):
            yield (
                f"{key}.trap.k = {kind.trap.k:g}: it swings by {swing:.2g} rad in a timestep; "
                f"above {SWING:g} its velocity is too hot: a weaker trap or a shorter timestep"
            )
        if above(THIN_BODY, solid.thinnest, 3):
            yield (
                f"{key}: it is {solid.thinnest:.3g} cells thick; below {THIN_BODY:g} the flow "
                f"around it is not resolved: give all lengths {THIN_BODY / solid.thinnest:.2g} "
                "times as many cells"
            )
        own = mass / solid.volume
        if kind.virtual == "fill" and above(density, own, 4):
            yield (
                f"{key}: its density {own:.4g} is below that of the fluid, {density:.4g}: its "
                "virtual particles are thinned in proportion"
            )
        stride = fluid.timestep * math.sqrt(fluid.kT / mass) / (0.5 * solid.thinnest)
        if above(stride, LONG_STRIDE):
            yield (
                f"fluid.timestep = {fluid.timestep:g}: in one, {key} moves by {stride:.2g} of its "
                f"radius; above {LONG_STRIDE:g} it is too hot: a shorter timestep or a larger mass"
            )
        yield from _hit_into_gaps(case, key, kind, mass)
    yield from _images_of_bodies(case)
    yield from _turning_bodies(case, numbers)
    yield from _pushed_bodies(case)
    yield from _fast_bodies(case)
    stirred = any(kind.swim is not None or any(_moved(case, kind)) for kind in case.bodies)
    if stirred and fluid.collision.acts and not setting.isothermal(case):
        yield (
            "no thermostat: bodies that swim, or that forces move, heat the fluid for ever; use "
            "fluid.thermostat.rule = 'maxwell-boltzmann', or fluid.collision.rule = 'at+a'"
        )


def _hit_into_gaps(case: Case, key: str, kind: Any, mass: float) -> Iterator[str]:
    """Hits move a body by half of what they change its velocity, after the gaps of the step.

    The energy is that of a spring of the stiffness 72 depth/range^2 of the gap law at its end.
    """
    fluid, alone = case.fluid, sum(one.number for one in case.bodies) == 1 and not case.walls
    if alone or not kind.interaction.depth:
        return
    solid = kind.solid(case.box.dimension)
    density = solid.volume * fluid.density * fluid.mass / mass
    thermal = math.sqrt(fluid.kT / fluid.mass)
    lost = min(1.6 * density * thermal * fluid.timestep / (0.5 * solid.thinnest), 1.0)
    moved = 0.5 * fluid.timestep * math.sqrt(2.0 * lost * fluid.kT / mass)
    heat = 36.0 * kind.interaction.depth * (moved / kind.interaction.range) ** 2
    if above(heat, HOT_GAPS):
        yield (
            f"fluid.timestep = {fluid.timestep:g}: hits move {key} by {moved:.2g} cells after the "
            f"gap law has acted, which brings bodies that touch about {heat:.2g} kT a step; above "
            f"{HOT_GAPS:g} they are too hot: a shorter timestep or a longer interaction.range"
        )


def _idle(case: Case, kind: Any) -> Iterator[str]:
    """A force or torque on what is fixed."""
    by_force, by_torque = _moved(case, kind)
    if np.any(kind.force or 0.0) and not by_force:
        yield f"force = {show(kind.force)}: it acts along fixed axes alone, and moves nothing"
    if np.any(kind.torque or 0.0) and not by_torque:
        yield f"torque = {show(kind.torque)}: the orientation is fixed, so that it turns nothing"
    elif kind.hinge is not None and kind.frame == "box" and np.any(kind.torque or 0.0):
        along = abs(np.dot(kind.torque, kind.hinge))
        if along <= 1e-9 * math.hypot(*kind.torque) * math.hypot(*kind.hinge):
            yield (
                f"torque = {show(kind.torque)}: it acts across hinge = {show(kind.hinge)}, so that "
                "it turns nothing"
            )


def _beside_the_line(kind: Any) -> Iterator[str]:
    """A counter-force that turns the body, which takes the opposite of its moment."""
    if kind.counter is None or kind.counter.at is None or "orientation" in kind.fixed:
        return
    at, force = (np.pad(row, (0, 3 - len(row))) for row in (kind.counter.at, kind.force))
    torque = np.cross(at, force)
    if np.linalg.norm(torque) > 1e-9 * np.linalg.norm(at) * np.linalg.norm(force):
        size = torque[2].item() if len(kind.force) == 2 else torque.tolist()
        yield (
            f"counter.at = {show(kind.counter.at)}: beside the line of force = {show(kind.force)}, "
            f"so that the two turn the body, with a torque of {show(size)}"
        )


def _trap_at_wall(case: Case, kind: Any) -> Iterator[str]:
    """A place that a wall keeps the body from."""
    if kind.trap is None or kind.trap.centre is None or not case.walls:
        return
    from mesokit.method.mpcd.start.body_room import walls_away

    thick = kind.solid(case.box.dimension).thinnest
    (away,) = walls_away(case, 0.5 * thick)(np.array([kind.trap.centre], float)).tolist()
    if above(0.5 * thick, away, 3):
        there = f"{away:.3g} cells from a wall" if away > 0 else "inside a wall"
        yield (
            f"trap.centre = {show(kind.trap.centre)}: {there}, and the body is {thick:.3g} cells "
            "thick: the trap presses it against the wall"
        )


def _moved(case: Case, kind: Any) -> tuple[bool, bool]:
    """Whether a force, and whether a torque, moves a body or the fluid."""
    free = [axis not in kind.fixed for axis in case.box.axes]
    force, counter = np.array(kind.force or 0.0), kind.counter
    acts = force.any() and (np.any(free) if kind.frame == "body" else np.any(force * free))
    turns = "orientation" not in kind.fixed or (counter is not None and counter.shell > 0)
    by_force = bool(acts or (force.any() and kind.balanced))
    return by_force, bool(np.any(kind.torque or 0.0) and turns)


def _images_of_bodies(case: Case) -> Iterator[str]:
    """Pairs of bodies that two images of one another could touch at once."""
    d, closed = case.box.dimension, setting.closed_axes(case)
    shortest = min((n for k, n in enumerate(case.box.size) if k not in closed), default=math.inf)
    many = [kind for kind in case.bodies for _ in range(min(kind.number, 2))]
    reaches = [kind.solid(d).radius + 0.5 * kind.interaction.range for kind in many]
    reach = sum(sorted(reaches)[-2:]) if len(many) > 1 else 0.0
    if above(reach, 0.5 * shortest, 4):
        yield (
            f"bodies: two of them reach {reach:.4g} from centre to centre, more than half of the "
            f"box of {shortest:g}: of the images of another, only the nearest repels"
        )


def _turning_bodies(case: Case, numbers: Derived) -> Iterator[str]:
    """Bodies that turn in a fluid whose stress has a torque of its own."""
    rule, d = case.fluid.collision, case.box.dimension
    turning = any("orientation" not in kind.fixed for kind in case.bodies)
    known = {name: part for name, part in family_of(rule).parts.items() if part.acts}
    better = [name for name, part in known.items() if "angular momentum" in part.conserves]
    if not (turning and rule.acts) or "angular momentum" in rule.conserves:
        return
    friction = "a lower rotational friction"
    if numbers.solvent is not None:
        share = numbers.solvent.viscosity_collisional / numbers.solvent.viscosity
        kept, one = 1.0 - share / (2 if d == 2 else 3), "disk" if d == 2 else "sphere"
        friction = f"{kept:.2g} of the rotational friction of a {one}"
    yield (
        f"fluid.collision.rule = {name_of(rule)!r}: it does not conserve angular momentum: bodies "
        f"have {friction}, and turn too fast in a shear flow; use {one_of(better)}"
    )


def _pushed_bodies(case: Case) -> Iterator[str]:
    """A net force on bodies that nothing takes."""
    total = np.zeros(case.box.dimension)
    for kind in case.bodies:
        if kind.force is None or kind.frame == "body" or kind.balanced or kind.trap:
            continue
        free = [axis not in kind.fixed for axis in case.box.axes]
        total += kind.number * np.array(kind.force) * free
    along = [axis for axis, force in zip(case.box.axes, total, strict=True) if force]
    if along and not case.walls:
        yield (
            f"bodies: together they are pushed along {' and '.join(along)}, and nothing holds the "
            "fluid: the whole box speeds up for ever; use walls, or counter_force = true"
        )


def _fast_bodies(case: Case) -> Iterator[str]:
    """Bodies beside whose speed that of sound is not large, or that of spreading momentum; those
    whose velocity outlasts the run."""
    for i, (name, kind) in enumerate(named(case.bodies), start=1):
        body = followed(case, "check", name)
        found, length = body.roughly(), case.run.steps * case.fluid.timestep
        lasts = body.mass * found.diffusion / case.fluid.kT
        if body.mass > HEAVY * body.displaced and body.moving and lasts > length:
            yield (
                f"bodies[#{i}]: a velocity of so heavy a body lasts {lasts:.2g} tau, longer than "
                f"the run of {length:.2g} tau: its motion stays that of the start"
            )
        causes = {"B1": kind.swim is not None, "force": np.any(kind.force or 0.0)}
        less = " or ".join(cause for cause, acts in causes.items() if acts)
        known = setting.solvent(case)
        mach = found.speed / (known.sound_speed if known else setting.sound_speed(case))
        if above(mach, FAST_BODY):
            yield (
                f"bodies[#{i}]: expected to move at Mach number {mach:.2g}: above {FAST_BODY:g} "
                f"the fluid is compressible; a smaller {less}"
            )
        if above(found.reynolds, INERTIAL):
            yield (
                f"bodies[#{i}]: expected to move at Reynolds number {found.reynolds:.2g}: above "
                f"{INERTIAL:g} inertia changes its flow and speed; a smaller {less}"
            )
        if kind.counter is not None and kind.counter.at is not None:
            d = case.box.dimension
            apart = found.reynolds * math.hypot(*kind.counter.at) / kind.solid(d).radius
            if above(apart, INERTIAL_PAIR[d]):
                yield (
                    f"bodies[#{i}]: expected U d/nu = {apart:.2g}, of its speed and the distance "
                    f"of its counter-force; above {INERTIAL_PAIR[d]:g} inertia takes or gives more "
                    f"than a tenth of the speed; a smaller {less}"
                )
