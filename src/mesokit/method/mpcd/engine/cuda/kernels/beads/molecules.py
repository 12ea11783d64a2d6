"""What one thread does for a molecule in a step: collide its beads, move them, bring them to cells.

Time levels are those of single particles (see `kernels.particles`). Beads stay in the rows of all
particles between the sub-steps: neighbouring threads read neighbouring places of a row.
"""

from typing import NamedTuple

from mesokit.case.box import SLIDING, at_time
from mesokit.devices.device import BLOCK
from mesokit.geometry.protocol import touches
from mesokit.method.mpcd.engine.beads.interactions import Virial
from mesokit.method.mpcd.engine.beads.links import Kick, each_link
from mesokit.method.mpcd.engine.beads.molecules import add_swing, swung
from mesokit.method.mpcd.engine.beads.moving import accelerated
from mesokit.method.mpcd.engine.beads.registers import in_image_of
from mesokit.method.mpcd.engine.beads.verlet import drift, flown, kick, verlet
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.physics import field_of, has_solid
from mesokit.method.mpcd.engine.cuda.kernels.beads.links import (
    KickInRows,
    OneMolecule,
    VirialInRows,
    note_broken_links,
    place_of,
)
from mesokit.method.mpcd.engine.cuda.kernels.particles import around, bring, collide_particle
from mesokit.method.mpcd.engine.cuda.kernels.rows import from_rows, to_rows
from mesokit.method.mpcd.molecule import Dimers
from mesokit.scalar.jit import by_type, elementwise, for_each, scalar
from mesokit.scalar.pointer import WORD, put_whole, whole  # noqa: F401  as does a text below
from mesokit.scalar.vector import added_scaled, scaled


class MovingMolecule(NamedTuple):
    """A molecule in flight, and the stages of the step."""

    molecule: OneMolecule
    flags: int


@scalar
def sweep_molecule(i, physics, now, fluid):
    """The pending collision of all beads, the flight, and what they bring to their next cells."""
    zero, apart, beads = physics.zero, fluid.molecules, physics.molecule.beads
    before = at_time(now.box, (now.counter.step - 1) * physics.timestep)
    # The first bead comes last: under shear the others return to its image, by its counts.
    for k in range(beads - 1, -1, -1):  # velocities at t, after the collision
        place = i + k * apart
        r, v = from_rows(fluid.r, place, zero), from_rows(fluid.v, place, zero)
        v = collide_particle(place, physics, now, fluid, r, v)
        if now.flags & STREAM:
            r, v = beside_first(before, fluid, i, place, r, v)
            to_rows(fluid.r, place, r)
        to_rows(fluid.v, place, v)
    if now.flags & STREAM:
        fly_molecule(MovingMolecule(OneMolecule(fluid, i), now.flags), now, physics)
        for k in range(beads):  # positions and velocities at t + dt, and cells
            place = i + k * apart
            r, v = from_rows(fluid.r, place, zero), from_rows(fluid.v, place, zero)
            to_rows(fluid.v, place, bring(place, physics, now, fluid, r, v))


@by_type
def beside_first(box, fluid, first, place, r, v):
    """Place and velocity of a bead, under shear in the image of the first one of its molecule."""
    return _beside_first if box.instance_class in SLIDING else _as_it_is


def _as_it_is(box, fluid, first, place, r, v):
    return r, v


def _beside_first(box, fluid, first, place, r, v):
    counts = counts_in_rows(fluid.image, first, r)
    r, v = in_image_of(box, r, v, counts_in_rows(fluid.image, place, r), counts)
    counts_to_rows(fluid.image, place, counts)
    return r, v


@elementwise
def counts_in_rows(image, place, pattern):
    """Boxes that a bead is away, as floats."""
    return "float(whole(image[{k}], place))"


@for_each
def counts_to_rows(image, place, counts):
    """Write the counts of boxes of a bead."""
    return "put_whole(image[{k}], place, int(counts[{k}]))"


@by_type
def fly_molecule(moving, now, physics):
    """Positions and velocities of the beads a timestep later (see `beads.molecules`)."""
    return _fly_dimer if field_of(physics, "molecule").instance_class is Dimers else _fly_springs


def _fly_dimer(moving, now, physics):
    fluid, zero = moving.molecule.fluid, physics.zero
    first, second = place_of(moving.molecule, 0), place_of(moving.molecule, 1)
    r, v = from_rows(fluid.r, first, zero), from_rows(fluid.v, first, zero)
    r2, v2 = from_rows(fluid.r, second, zero), from_rows(fluid.v, second, zero)
    if moving.flags & MEASURE_STRESS:
        separation, rate = added_scaled(r2, -1.0, r), added_scaled(v2, -1.0, v)
        add_swing(physics, separation, rate, tensor_of(moving, physics))
    r, v, r2, v2 = swung(physics, r, v, r2, v2)
    to_rows(fluid.r + fluid.v, first, r + v)
    to_rows(fluid.r + fluid.v, second, r2 + v2)


def _fly_springs(moving, now, physics):
    verlet(moving, now, physics, physics.molecule.substeps)


@kick.register(MovingMolecule)
def _(moving, step, box, physics, time):
    springs, zero, fluid = physics.molecule, physics.zero, moving.molecule.fluid
    if moving.flags & MEASURE_STRESS:
        virial = Virial(time, tensor_of(moving, physics), physics.stress_scale)
        each_link(VirialInRows(virial), springs, moving.molecule, 1, zero)
    change = KickInRows(Kick(time * springs.inverse_mass))
    if each_link(change, springs, moving.molecule, 1, zero):
        note_broken_links(moving.molecule, step, springs, zero)
    for k in range(springs.beads):
        place = place_of(moving.molecule, k)
        r, v = from_rows(fluid.r, place, zero), from_rows(fluid.v, place, zero)
        to_rows(fluid.v, place, accelerated(physics.field, time, r, v))


@by_type
def tensor_of(moving, physics):
    """Where the stress of the bonds of a molecule is added up: the row of its block."""
    if len(field_of(field_of(field_of(moving, "molecule"), "fluid"), "tensor")) == 0:
        return lambda moving, physics: 0
    return _tensor_of


def _tensor_of(moving, physics):
    terms = 2 * len(physics.zero) * len(physics.zero)
    return moving.molecule.fluid.tensor[2] + moving.molecule.number // BLOCK * terms * WORD


@drift.register(MovingMolecule)
def _(moving, counter, physics, time):
    for k in range(physics.molecule.beads):
        place, fluid = place_of(moving.molecule, k), moving.molecule.fluid
        r, v = from_rows(fluid.r, place, physics.zero), from_rows(fluid.v, place, physics.zero)
        r, v = flown_straight(fluid, place, counter, physics, time, r, v)
        to_rows(fluid.r + fluid.v, place, r + v)


@by_type
def flown_straight(fluid, place, counter, physics, time, r, v):
    """Place and velocity of a bead a time later, after straight flight with reflections."""
    return _flown_among_solids if has_solid(physics) else _flown_straight


def _flown_straight(fluid, place, counter, physics, time, r, v):
    return added_scaled(r, time, v), v


def _flown_among_solids(fluid, place, counter, physics, time, r, v):
    if touches(physics.solid, around(physics.solid, r), r, v, scaled(0.0, r), time):
        number, (m,) = whole(fluid.ident, place), physics.masses
        return flown(physics, time, counter, number, m, r, v, fluid.impulse)
    return added_scaled(r, time, v), v
