"""Solutes that are fine alone and wrong with the rest of a case: see `combinations`."""

import math
from collections.abc import Iterator

from mesokit.case.case import Case
from mesokit.case.component import name_of, one_of, show
from mesokit.case.registry import family_of
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.molecule import FLUID, MOST_SUBSTEPS, UNSTABLE
from mesokit.method.mpcd.solutes import Solutes
from mesokit.potential.thermal import mean_square

MOST_EXCLUDED = 0.9  # of the fluid's volume
MOST_BEADS = 2**31 - 1  # their numbers are 32-bit


def solutes(case: Case) -> Iterator[str]:
    """Beads that fit into the box and that the fluid can carry."""
    given = case.solutes
    if given is None:
        return
    if case.fluid.molecule is not None:
        for key, value in (("coupling", "potential"), ("solvent", "random")):
            if getattr(given, key) == value:
                here = f"solutes.{key} = {show(value)}"
                yield f"{here}: not with fluid.molecule; leave one of both out"
        if FLUID in given.names:
            place = 1 + given.names.index(FLUID)
            yield (
                f"solutes.polymers[#{place}].name = {show(FLUID)}: this names the molecules of the "
                "fluid (fluid.molecule); expected another name"
            )
    if given.beads > MOST_BEADS:
        yield f"solutes.polymers: {given.beads} beads; expected at most {MOST_BEADS}"
    yield from _sizes(case, given)
    yield from _substeps(case, given)
    if given.solvent == "random":
        yield from _random_solvent(case)
    yield from external(case, given)
    if given.coupling == "potential":
        yield from _potential(case, given)


def _sizes(case: Case, given: Solutes) -> Iterator[str]:
    """No bead that interacts with two images of another, no bond that could lead to either."""
    closed = closed_axes(case.walls)
    lengths = dict(zip(case.box.axes, case.box.size, strict=True))
    shortest = min((n for axis, n in lengths.items() if axis not in closed), default=math.inf)
    for pair in given.different_pairs:
        if pair.reach > 0.5 * shortest:
            key = "solutes.pair" if pair == given.pair else "solutes: a pair potential"
            yield f"{key}: it reaches {pair.reach:.3g}, more than half of the box of {shortest}"
    for kind in range(len(given.polymers)):
        molecule = given.molecule(kind)
        if molecule is None:
            continue
        longest = molecule.bond.longest
        kernels = molecule.bond_potentials
        size = math.sqrt(mean_square(kernels, case.box.dimension, case.fluid.kT, longest))
        if size > 0.5 * shortest:
            yield (
                f"solutes.bond: its root-mean-square length {size:.3g} is more than half of the "
                f"box of {shortest}"
            )
    if given.solvent_pair is not None and given.solvent_pair.reach > 0.5 * shortest:
        yield (
            f"solutes.solvent_pair: it reaches {given.solvent_pair.reach:.3g}, more than half of "
            f"the box of {shortest}"
        )
    if given.wall is None:
        return
    if not case.walls:
        yield "solutes.wall: there are no walls; give some, or leave it out"
    for axis in closed:
        if given.wall.reach > 0.5 * lengths[axis]:
            yield (
                f"solutes.wall: it reaches {given.wall.reach:.3g}, more than half of the "
                f"{lengths[axis]} between the plates"
            )


def _substeps(case: Case, given: Solutes) -> Iterator[str]:
    fluid, d = case.fluid, case.box.dimension
    need = given.needed_substeps(d, fluid)
    if given.substeps is None:
        if need > MOST_SUBSTEPS:
            yield (
                f"solutes: the stiffest potential or the magnetic field needs {need} sub-steps in "
                f"a timestep; expected at most {MOST_SUBSTEPS}: softer potentials, weaker fields, "
                "or a shorter fluid.timestep"
            )
        return
    lightest = min(kind.mass for kind in fluid.kinds)
    phase = given.frequency(d, fluid.kT, lightest) * fluid.timestep / given.substeps
    if phase >= UNSTABLE:
        yield (
            f"solutes.substeps = {given.substeps}: the stiffest potential or the magnetic field "
            f"turns by {phase:.3g} rad in each, and velocity Verlet is unstable from {UNSTABLE:g} "
            f"on; expected {need}"
        )


def _random_solvent(case: Case) -> Iterator[str]:
    """A solvent at rest, of which nothing can be measured."""
    key = "solutes.solvent = 'random'"
    if "angular momentum" in case.fluid.collision.conserves:
        yield f"{key}: not with fluid.collision.rule = {show(name_of(case.fluid.collision))}"
    if case.fluid.species:
        yield f"{key}: not with fluid.species"
    if case.walls:
        yield f"{key}: not with walls; there is no fluid that they could hold"
    if case.box.sheared:
        yield f"{key}: not in a sheared box; the solvent is at rest"
    for i, observable in enumerate(case.observe):
        if observable.needs_fluid:
            others = family_of(observable).parts.items()
            expected = [name for name, part in others if not part.needs_fluid]
            yield (
                f"observe[#{i + 1}].quantity = {show(name_of(observable))}: there is no fluid to "
                f"measure; expected {one_of(expected)}"
            )


def _potential(case: Case, given: Solutes) -> Iterator[str]:
    """A fluid with room for what pushes it away, and nothing that such beads do not do yet."""
    key = "solutes.coupling = 'potential'"
    if given.solvent == "random":
        yield f"{key}: not with solutes.solvent = 'random', which has no particles; use 'fluid'"
    if case.box.sheared:
        yield f"{key}: not in a sheared box; move a plate (wall.upper.velocity) to shear a slit"
    if case.box.open:
        yield f"{key}: not with box.open"
    for i, observable in enumerate(case.observe):
        if "stress" in observable.measures:
            name = show(name_of(observable))
            yield f"observe[#{i + 1}].quantity = {name}: not with {key}"
    excluded, room = given.excluded_volume(case.box.dimension, case.fluid.kT), free_volume(case)
    if given.beads * excluded > MOST_EXCLUDED * room:
        yield (
            f"solutes.solvent_pair: {given.beads} beads exclude the fluid from "
            f"{given.beads * excluded:.4g} of {room:.4g} cells; expected at most "
            f"{MOST_EXCLUDED:.0%}: fewer or smaller beads"
        )


def external(case: Case, given: Solutes) -> Iterator[str]:
    """Errors: unknown beads, vectors of a wrong length, traps in a sheared box or too stiff."""
    d, lists = case.box.dimension, ("pulls", "traps", "magnetic")
    for name in lists:
        for i, part in enumerate(getattr(given, name)):
            key = f"solutes.{name}[#{i + 1}]"
            try:
                part.beads(given)
            except CaseError as error:
                yield f"{key}.{error}"
            for vector in ("force", "centre"):
                value = getattr(part, vector, None)
                if value is not None and len(value) != d:
                    yield f"{key}.{vector} = {show(value)}: expected {d} numbers, one for each axis"
            centre = getattr(part, "centre", ())
            for axis, place, length in zip(case.box.axes, centre, case.box.size, strict=False):
                if axis not in case.box.open and not 0 <= place <= length:
                    yield (
                        f"{key}.centre = {show(centre)}: outside the box along {axis}; expected 0 "
                        f"to {length:g}"
                    )
            if name != "pulls" and case.box.sheared:
                yield f"{key}: not in a sheared box, whose images move"
            if given.coupling == "potential":
                yield f"{key}: not with solutes.coupling = 'potential'"
    for i, field in enumerate(given.magnetic):
        if d == 2 and any(field.field[:2]):
            yield (
                f"solutes.magnetic[#{i + 1}].field = {show(field.field)}: expected [0, 0, B] in 2D"
            )
    for i, trap in enumerate(given.traps):
        time = case.fluid.timestep / given.number_of_substeps(d, case.fluid)
        phase = (trap.k / min(given.masses)) ** 0.5 * time
        if phase >= UNSTABLE:
            yield (
                f"solutes.traps[#{i + 1}].k = {show(trap.k)}: it turns by {phase:.3g} rad in a "
                f"sub-step and is unstable from {UNSTABLE:g} on; take more solutes.substeps"
            )
