"""Bodies that are fine alone and wrong with the rest of a case: see `combinations`."""

import math
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import name_of, one_of, show, tag_of
from mesokit.geometry.primitive import PRIMITIVES
from mesokit.geometry.shape_protocol import Movable, closed_axes
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.body.inertia import is_inside
from mesokit.method.mpcd.body.protocol import Body, named
from mesokit.method.mpcd.body.substeps import needed_substeps
from mesokit.method.mpcd.body.union import UnionBody, moves
from mesokit.method.mpcd.molecule import MOST_SUBSTEPS
from mesokit.method.mpcd.solutes import Solutes

MOST_BODIES = 2**24
MOST_FILLED = 0.9  # of the volume that walls leave
LEAST_MASS = 10.0  # particles of the fluid
LEAST_NEARBY = 5.0  # particles that take a counter-force
ROOM = 4.0  # cells from a body to its own image
RESERVED = re.compile(r"all|bodies|solutes|suspended|fluid(-\d+)?")  # names of other particles
LONGEST_PATH = 0.35  # cells in a timestep: the engine's lists of gaps hold so far
MOST_SPEEDS = 4.0  # thermal velocities: a body has more in one of 16,000 steps
MOST_SWING = math.pi  # radians of a trap in a timestep
LEAST_LENGTH, MOST_LENGTH = 1e-3, 1e6  # cells, half of that of a body
THIN_BODY = 2.0  # cells across, below which flow around it is not resolved
RADII = ("radius", "half_length")
SIZES = ("radius", "half_length", "length", "size", "parts")  # keys that say how large one is


def bodies(case: Case) -> Iterator[str]:
    """Bodies that fit the box, and nothing that they do not do yet."""
    if not case.bodies:
        return
    yield from _not_yet(case)
    labels: dict[str, int] = {}
    for i, (label, kind) in enumerate(named(case.bodies), start=1):
        key = f"bodies[#{i}]"
        yield from (f"{key}.{problem}" for problem in _shape(case, kind))
        yield from (f"{key}.{problem}" for problem in _vectors(case, kind))
        yield from (f"{key}.{problem}" for problem in _idle_trap(case, kind))
        yield from (f"{key}.{problem}" for problem in _rows(case, kind))
        yield from (f"{key}.{problem}" for problem in _size(case, kind))
        yield from (f"{key}.{problem}" for problem in _fast(case, kind))
        yield from (f"{key}.{problem}" for problem in _counter_force(case, kind))
        yield from (f"{key}.{problem}" for problem in _counter(case, kind))
        if kind.swim is not None and kind.swim.tumble_rate and not kind.tumbles:
            yield (
                f"{key}.swim.tumble_rate = {show(kind.swim.tumble_rate)}: only of a sphere or a "
                "disk; others have no room to turn at once"
            )
        if RESERVED.fullmatch(label):
            yield f"{key}.name = {show(label)}: reserved for particles; expected another name"
        if label in labels:
            first = f"bodies[#{labels[label]}]"
            yield f"{key}.name: {show(label)} is also the name of {first}; rename one"
        labels[label] = i
    total = sum(kind.number for kind in case.bodies)
    if total > MOST_BODIES:
        yield f"bodies: {total} in all; expected at most {MOST_BODIES}"
    d, room = case.box.dimension, free_volume(case)
    filled = sum(kind.number * kind.solid(d).volume for kind in case.bodies)
    if filled > MOST_FILLED * room:
        shares = [kind.number * kind.solid(d).volume for kind in case.bodies]
        most = shares.index(max(shares))
        number = case.bodies[most].number
        said = f"bodies[#{most + 1}].number = {number}: bodies" if number > 1 else "bodies: they"
        yield (
            f"{said} fill {filled:.4g} of {room:.4g} cells; expected at most "
            f"{MOST_FILLED:.0%}: fewer or smaller bodies"
        )
    if case.solutes is not None and (need := needed_substeps(case)) > MOST_SUBSTEPS:
        yield (
            f"bodies: the stiffest gap of a bead needs {need} sub-steps in a timestep; expected at "
            f"most {MOST_SUBSTEPS}: less interaction.depth, heavier beads (solutes.mass), or a "
            "shorter fluid.timestep"
        )


def _not_yet(case: Case) -> Iterator[str]:
    """What bodies cannot be together with."""
    fluid, rule = case.fluid, case.fluid.collision
    if case.box.open:
        yield f"box.open = {show(list(case.box.open))}: not with bodies; leave one of both out"
    if fluid.molecule is not None:
        yield "fluid.molecule: not with bodies yet; expected a fluid of single particles"
    if fluid.mixed:
        yield "fluid.species: of different mass, not with bodies yet; expected one mass"
    if case.solutes is not None:
        yield from _beads(case, case.solutes)
    if rule.gradient_of is not None:
        yield f"fluid.collision.rule = {show(name_of(rule))}: not with bodies yet; use 'srd'"


def _beads(case: Case, solutes: Solutes) -> Iterator[str]:
    """Beads that collide with the fluid, and bodies that keep them out."""
    if solutes.coupling == "potential":
        yield "solutes.coupling = 'potential': not with bodies yet; expected 'collision'"
    if solutes.solvent == "random":
        yield "solutes.solvent = 'random': not with bodies, which a fluid moves; expected 'fluid'"
    for i, kind in enumerate(case.bodies, start=1):
        if not kind.interaction.depth:
            yield (
                f"bodies[#{i}].interaction.depth = 0: not with solutes, whose beads would enter "
                "the body; expected more than 0"
            )


def _known_motion(case: Case, kind: Body) -> Iterator[str]:
    """Given velocities along what is fixed, and spins about other axes than the hinge."""
    velocities, spins, hinge = kind.start.velocities, kind.start.spins, kind.hinge or ()
    rows = () if velocities is None or isinstance(velocities, str) else velocities
    for i, row in enumerate(rows, start=1):
        for axis, speed in zip(case.box.axes, row, strict=False):
            if speed and axis in kind.fixed:
                yield f"start.velocities[#{i}] = {show(row)}: expected 0 along {axis}, as fixed"
    rows = () if spins is None or isinstance(spins, str) else spins
    for i, row in enumerate(rows, start=1):
        if len(row) == len(hinge) == 3 and np.linalg.norm(np.cross(row, hinge)) > 1e-9:
            yield f"start.spins[#{i}] = {show(row)}: expected a multiple of hinge = {show(hinge)}"


def _shape(case: Case, kind: Body) -> Iterator[str]:
    """A shape of this dimension, and its parts likewise."""
    from mesokit.geometry.shape import SHAPES
    from mesokit.method.mpcd.body import BODIES

    d = case.box.dimension
    usable = [found[1] for one in BODIES if d in one.dimensions and (found := tag_of(one))]
    if d not in kind.dimensions:
        yield f"shape = {show(name_of(kind))}: not in {d}D; expected {one_of(usable)}"
    simple = [found[1] for one in SHAPES if issubclass(one, Movable) and (found := tag_of(one))]
    expected = one_of([name for name in usable if name in simple])
    for i, part in enumerate(kind.parts if isinstance(kind, UnionBody) else (), start=1):
        key = f"parts[#{i}]"
        if d not in part.dimensions:
            yield f"{key}.shape = {show(name_of(part))}: not in {d}D; expected {expected}"
        for name, vector in part.vectors().items():
            if len(vector) != d:
                yield f"{key}.{name} = {show(vector)}: expected {_numbers(d)}"
            if max(map(abs, vector)) > MOST_LENGTH:
                yield f"{key}.{name} = {show(vector)}: expected numbers of at most {MOST_LENGTH:g}"
        if not moves(part):
            yield (
                f"{key}.shape = {show(name_of(part))}: not part of a body that moves; expected "
                f"{expected}"
            )


def _numbers(d: int) -> str:
    return f"{d} numbers, one for each axis of the {d}D box"


def _vectors(case: Case, kind: Body) -> Iterator[str]:
    """One number for each axis; in 2D all turning is about z."""
    d, trap = case.box.dimension, kind.trap
    given: list[tuple[str, Any]] = [("force", kind.force)]
    if trap is not None:
        given += [("trap.centre", trap.centre), ("trap.direction", trap.direction)]
    for key, vector in given:
        if vector is not None and len(vector) != d:
            yield f"{key} = {show(vector)}: expected {_numbers(d)}"
    if d == 2 and isinstance(kind.torque, tuple):
        yield f"torque = {show(kind.torque)}: expected one number in 2D, about z"
    elif d == 3 and not (kind.torque is None or _is_vector(kind.torque)):
        yield f"torque = {show(kind.torque)}: expected 3 numbers in 3D"
    if d == 2 and "z" in kind.fixed:
        yield f"fixed = {show(kind.fixed)}: a 2D box has only 'x' and 'y'"
    if case.box.sheared and "x" in kind.fixed and "y" not in kind.fixed:
        yield (
            f"fixed = {show(kind.fixed)}: under box.shear_rate 'x' needs 'y', as images above and "
            "below slide along x"
        )
    if kind.hinge is not None and d == 2:
        yield f"hinge = {show(kind.hinge)}: only in 3D; in 2D all bodies turn about z alone"
    elif kind.hinge is not None and len(kind.hinge) != 3:
        yield f"hinge = {show(kind.hinge)}: expected {_numbers(d)}"
    if trap is None or trap.centre is None:
        return
    for axis, place, length in zip(case.box.axes, trap.centre, case.box.size, strict=True):
        if not 0 <= place <= length:
            yield (
                f"trap.centre = {show(trap.centre)}: outside the box along {axis}; expected 0 to "
                f"{length:g}"
            )


def _idle_trap(case: Case, kind: Body) -> Iterator[str]:
    """Springs of a trap along what never moves, or about the hinge of a body."""
    if kind.trap is None:
        return
    towards, hinge = kind.trap.direction or (1.0, 0.0, 0.0), kind.hinge or (0.0, 0.0, 0.0)
    if kind.trap.angular and kind.hinge is not None and len(towards) == len(hinge) == 3:
        across = np.linalg.norm(np.cross(towards, hinge))
        if across <= 1e-9 * np.linalg.norm(towards) * np.linalg.norm(hinge):
            yield (
                f"trap.angular = {show(kind.trap.angular)}: its direction {show(towards)} is along "
                f"hinge = {show(kind.hinge)}, about which it turns nothing; expected one across it"
            )
    still = all(axis in kind.fixed for axis in case.box.axes), "orientation" in kind.fixed
    for name, idle in zip(("k", "angular"), still, strict=True):
        if idle and getattr(kind.trap, name):
            given = f"trap.{name} = {show(getattr(kind.trap, name))}"
            yield f"{given}: not with fixed = {show(list(kind.fixed))}, which holds it still"


def _is_vector(given: Any) -> bool:
    return isinstance(given, tuple) and len(given) == 3


def _rows(case: Case, kind: Body) -> Iterator[str]:
    """A row for each body in what is given of its start, and places in the box."""
    d, given = case.box.dimension, kind.start
    angle = "1 number, its angle" if d == 2 else "4 numbers, a quaternion"
    for name, width, what in (
        ("positions", d, f"{d} numbers"),
        ("orientations", 1 if d == 2 else 4, angle),
        ("velocities", d, f"{d} numbers"),
        ("spins", 1 if d == 2 else 3, "1 number, about z" if d == 2 else "3 numbers"),
    ):
        rows = getattr(given, name)
        if rows is None or isinstance(rows, str):  # files are read by the start
            continue
        if len(rows) != kind.number:
            yield (
                f"start.{name}: {len(rows)} row{'s' * (len(rows) != 1)}; expected {kind.number}, "
                "one for each body (number)"
            )
        for i, row in enumerate(rows, start=1):
            if len(row) != width:
                yield f"start.{name}[#{i}] = {show(row)}: expected {what}"
    if given.spins is not None and "orientation" in kind.fixed:
        yield "start.spins: not with fixed = 'orientation', which never turns"
    yield from _known_motion(case, kind)
    rows = () if given.positions is None or isinstance(given.positions, str) else given.positions
    for i, row in enumerate(rows, start=1):
        for axis, x, length in zip(case.box.axes, row, case.box.size, strict=True):
            if not 0 <= x <= length:
                yield (
                    f"start.positions[#{i}] = {show(row)}: outside the box along {axis}; expected "
                    f"0 to {length:g}"
                )


def _size(case: Case, kind: Body) -> Iterator[str]:
    """Room between a body and its own images; a mass that the fluid can push."""
    d, fluid = case.box.dimension, case.fluid
    half = max(PRIMITIVES[part.code].extent(part.numbers) for (part,) in kind.region())
    if not LEAST_LENGTH < half < MOST_LENGTH:  # its volume might be no number
        yield (
            f"{_said(kind, half)}: it is {2.0 * half:.4g} long; expected a length from "
            f"{2.0 * LEAST_LENGTH:g} to {2.0 * MOST_LENGTH:g}"
        )
    solid, closed = kind.solid(d), closed_axes(case.walls)
    said = _said(kind, solid.radius)
    for axis, length in zip(case.box.axes, case.box.size, strict=True):
        if axis not in closed and 2.0 * solid.radius + ROOM > length:
            yield (
                f"{said}: its images may meet, for it is {2.0 * solid.radius:.4g} long; expected "
                f"a length of at most {length - ROOM:g} in a box of {length:g} along {axis}"
            )
    mass = kind.mass_in(d, fluid.density * fluid.mass)
    if mass < LEAST_MASS * fluid.mass:
        found = f"a mass of {mass:.3g}"
        if kind.mass is not None:
            said = f"mass = {show(kind.mass)}"
        elif solid.thinnest < THIN_BODY:
            said = _said(kind, 0.5 * solid.thinnest)
            found = f"it is {solid.thinnest:.3g} cells thick, with {found}"
        elif kind.density is not None:
            said = f"density = {show(kind.density)}"
        yield (
            f"{said}: {found}; expected at least {LEAST_MASS * fluid.mass:g}, that of "
            f"{LEAST_MASS:g} particles of the fluid"
            + (
                f", and {THIN_BODY:g} cells: a finer resolution, with all lengths in more cells"
                if solid.thinnest < THIN_BODY
                else ""
            )
        )


def _said(kind: Body, radius: float) -> str:
    """What makes a body as long or as thin as it is, half of that given: key and value."""
    for key in SIZES:
        value = getattr(kind, key, None)
        if value is not None and (key not in RADII or math.isclose(value, radius)):
            return key if key == "parts" else f"{key} = {show(value)}"
    return f"shape = {show(name_of(kind))}"


def _fast(case: Case, kind: Body) -> Iterator[str]:
    """Starts, forces and traps by which the surface goes too far in the first timestep."""
    d, dt, kT = case.box.dimension, case.fluid.timestep, case.fluid.kT
    solid, mass = kind.solid(d), kind.mass_in(d, case.fluid.density * case.fluid.mass)
    moments = np.diag(solid.moments) * mass / solid.volume
    inertia = float(moments[2] if d == 2 else moments.max())
    free = [axis not in kind.fixed for axis in case.box.axes]
    gaps = kind.interaction.depth > 0
    least = f"expected at most {LONGEST_PATH:g}: a shorter fluid.timestep, or"
    # A surface that turns faster would throw the fluid out of its cells, with gaps or without.
    for name, arm, limited in (("velocities", 1.0, gaps), ("spins", solid.radius, True)):
        rows = getattr(kind.start, name)
        for i, row in enumerate(() if rows is None or isinstance(rows, str) else rows, start=1):
            path = math.hypot(*row) * arm * dt
            if path > LONGEST_PATH and limited:
                yield (
                    f"start.{name}[#{i}] = {show(row)}: it moves by {path:.3g} cells in a "
                    f"timestep; {least} slower"
                )
    if kind.swim is not None:
        path = abs(theory.squirmer_speed(kind.swim.B1, d, kind.aspect)) * dt
        if path > LONGEST_PATH and gaps and any(free):
            yield (
                f"swim.B1 = {show(kind.swim.B1)}: it swims by {path:.3g} cells in a timestep; "
                f"{least} smaller"
            )
        rate = kind.swim.tumble_rate
        if rate * dt > 1.0:
            yield (
                f"swim.tumble_rate = {show(rate)}: {rate * dt:.3g} turns in a timestep; expected "
                f"at most 1, or {1 / dt:g}"
            )
    thermal = MOST_SPEEDS * math.sqrt(kT / mass) * dt
    if thermal > LONGEST_PATH and gaps and any(free):
        yield (
            f"mass = {mass:.4g}: at {MOST_SPEEDS:g} thermal velocities it moves by {thermal:.3g} "
            f"cells in a timestep; {least} heavier"
        )
    force = np.array(kind.force or 0.0) * (1.0 if kind.frame == "body" else free)
    turn = kind.torque if isinstance(kind.torque, tuple) else (kind.torque or 0.0,)
    for name, size, per in (
        ("force", math.hypot(*np.atleast_1d(force)), mass),
        ("torque", math.hypot(*turn), inertia / solid.radius),
    ):
        path = size / per * dt**2
        fixed = name == "torque" and "orientation" in kind.fixed
        if path > LONGEST_PATH and gaps and not fixed:
            yield (
                f"{name} = {show(getattr(kind, name))}: in the first timestep the surface gets "
                f"to {path:.3g} cells in a timestep; {least} weaker"
            )
    stiff = (("k", mass), ("angular", float(moments[2]))) if kind.trap is not None else ()
    for name, per in stiff:
        k = getattr(kind.trap, name)
        swing = math.sqrt(k * kT / per) * dt
        if swing > MOST_SWING:
            yield (
                f"trap.{name} = {show(k)}: too stiff, it swings by {swing:.3g} rad in a timestep; "
                f"expected at most {MOST_SWING:.3g}, or {name} = "
                f"{k * (MOST_SWING / swing) ** 2:.3g}"
            )


def _counter_force(case: Case, kind: Body) -> Iterator[str]:
    """A uniform acceleration of everything that balances a constant force."""
    if not kind.counter_force:
        return
    key = "counter_force = true"
    if kind.force is None:
        yield f"{key}: needs a force that it balances"
    if kind.frame == "body":
        yield f"{key}: not with frame = 'body', whose force turns with the body; use 'box'"
    if case.walls:
        yield f"{key}: not with walls, which take the force; leave it out"
    if case.fluid.force.uniform(case.box.dimension) is None:
        rule = show(name_of(case.fluid.force))
        yield f"{key}: not with fluid.force.rule = {rule}; expected 'uniform' or 'none'"


def _counter(case: Case, kind: Body) -> Iterator[str]:
    """A ball and a shell in the fluid, which meet no image of the body."""
    d, counter = case.box.dimension, kind.counter
    if counter is None:
        return
    solid, reach, key = kind.solid(d), 0.0, f"counter.shell = {show(counter.shell)}"
    if counter.shell:
        reach = solid.radius + counter.shell
    if counter.at is not None:
        key = f"counter.at = {show(counter.at)}"
        if len(counter.at) != d:
            yield f"{key}: expected {_numbers(d)}"
            return
        far = math.hypot(*counter.at)
        reach = max(reach, far + counter.radius)
        if far < solid.radius and (solid.ball or is_inside(solid, counter.at)):
            least = f"{solid.radius:.4g} or more from its centre"
            expected = least if solid.ball else "a place outside"
            yield f"{key}: inside of the body; expected {expected}"
        unit = math.pi if d == 2 else 4.0 / 3.0 * math.pi
        number = case.fluid.density * unit * counter.radius**d
        if number < LEAST_NEARBY:
            yield (
                f"counter.radius = {show(counter.radius)}: about {number:.2g} particles; expected "
                f"{LEAST_NEARBY:g} or more to take the force"
            )
    closed = closed_axes(case.walls)
    for axis, length in zip(case.box.axes, case.box.size, strict=True):
        if axis not in closed and 2.0 * reach + ROOM > length:
            yield (
                f"{key}: it reaches {reach:.4g} from the centre; expected at most "
                f"{0.5 * (length - ROOM):g} in a box of {length:g} along {axis}"
            )
