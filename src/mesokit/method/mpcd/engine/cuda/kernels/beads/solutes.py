"""What one thread does for a bead of a solute in a step: collide, fly in sub-steps, meet its cell.

Forces need the places of other beads, so flights and kicks of a sub-step are launches of their own.
"""

from typing import Any, NamedTuple

from mesokit.loops.neighbours import too_far
from mesokit.method.mpcd.engine.beads.flight import (
    add_bead_flux,
    bin_bead,
    box_before,
    collide_bead,
)
from mesokit.method.mpcd.engine.beads.interactions import BeadForce, Virial
from mesokit.method.mpcd.engine.beads.moving import drift_bead, kick_bead
from mesokit.method.mpcd.engine.beads.neighbours import (
    CROWDED,
    apart,
    offset_of_images,
    slip_since,
    square_moved,
)
from mesokit.method.mpcd.engine.beads.state import GROUP, load_place
from mesokit.method.mpcd.engine.beads.traverse import each_on_bead
from mesokit.method.mpcd.engine.beads.verlet import box_after, drift, drift_in, kick, kick_after
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale
from mesokit.scalar.fixed_point import bits, from_bits
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import (
    WORD,
    put_real,
    put_reals,
    put_whole,
    raise_to,
    real,
    take_number,
    whole,
    word,
)
from mesokit.scalar.vector import dot, scaled


class MovingBead(NamedTuple):
    """A bead in flight, where surfaces leave what they take, and the stages of the step."""

    beads: Any
    number: int
    impulse: int
    flags: int


class DeviceLists(NamedTuple):
    """Neighbour lists of beads (see `beads.neighbours.Neighbours`), by addresses.

    offsets: of the images when the list of each bead was made, float64; moved: bits of the square
    of the longest displacement since then.
    """

    reach: float
    skin: float
    most: int
    count: Any
    near: int
    made_at: int
    boxes: int
    offsets: int
    moved: int


@scalar
def tensor_row(beads, when, i, zero):
    """The part in the stress of the group of bead i (see `Beads.tensor`)."""
    groups, terms = (beads.number + GROUP - 1) // GROUP, 2 * len(zero) * len(zero)
    return beads.tensor + (when * groups + i // GROUP) * terms * WORD


@scalar
def collide_solute(i, physics, now, fluid, beads):
    """Velocity of a bead after the pending collision, if there is one."""
    if now.flags & COLLIDE:
        collide_bead(beads, i, physics, box_before(now, physics), now.old, fluid.coefficients)
        if now.flags & MEASURE_STRESS and not now.flags & STREAM:
            tensor = tensor_row(beads, 1, i, physics.zero)
            add_bead_flux(tensor, beads, i, physics, now.box, now.old.shift)


@scalar
def drift_solute(i, physics, now, fluid, beads, n):
    """Place of a bead after the nth sub-step, from 1."""
    moving = MovingBead(beads, i, fluid.impulse, now.flags)
    drift_in(moving, now, physics, beads.potentials.substeps, n)
    note_moved(beads.neighbours, i, physics, now, beads, n)


@scalar
def stay_solute(i, physics, now, fluid, beads, n):
    """The same for n = 0: a bead stays where it is."""
    note_moved(beads.neighbours, i, physics, now, beads, n)


@scalar
def kick_solute(i, physics, now, fluid, beads, n):
    """Velocity of a bead after the kick that follows the nth flight, or goes before the first."""
    moving = MovingBead(beads, i, fluid.impulse, now.flags)
    kick_after(moving, now, physics, beads.potentials.substeps, n)


@drift.register(MovingBead)
def _(moving, counter, physics, time):
    drift_bead(moving.beads, moving.number, counter, physics, time, moving.impulse)


@kick.register(MovingBead)
def _(moving, step, box, physics, time):
    beads, i, zero = moving.beads, moving.number, physics.zero
    if moving.flags & MEASURE_STRESS:
        virial = Virial(time, tensor_row(beads, 2, i, zero), physics.stress_scale)
        each_on_bead(virial, (), beads, i, load_place(beads, i, zero), box)
    force = BeadForce(time, moving.impulse, momentum_scale(physics), step, beads.faults)
    kick_bead(force, scaled(0.0, zero), beads, i, box, physics, time)


@by_type
def note_moved(lists, i, physics, now, beads, n):
    """Note how far a bead has moved since its list was made; nothing without lists."""
    return _note_moved if len(lists) else lambda lists, i, physics, now, beads, n: None


def _note_moved(lists, i, physics, now, beads, n):
    (given,) = lists
    box = box_after(now, physics, beads.potentials.substeps, n)
    slip = slip_since(box, real(given.offsets, i))
    square = square_moved(given, i, load_place(beads, i, physics.zero), slip)
    raise_to(given.moved, 0, bits(square))


@scalar
def renew_list(i, physics, now, fluid, beads, n):
    """Make the list of a bead anew if any bead has moved too far: all others, by number."""
    (lists,) = beads.neighbours
    zero, d = physics.zero, len(physics.zero)
    box = box_after(now, physics, beads.potentials.substeps, n)
    slip = slip_since(box, real(lists.offsets, i))
    if too_far(from_bits(word(lists.moved, 0)), abs(slip), lists.skin):
        mine, found = load_place(beads, i, zero), 0
        for j in range(beads.number):
            separation = apart(box, mine, load_place(beads, j, zero))
            if j != i and dot(separation, separation) <= lists.reach * lists.reach:
                if found < lists.most:
                    put_whole(lists.near, i * lists.most + found, j)
                found += 1
        put_whole(lists.count, i, found if found <= lists.most else CROWDED)
        put_reals(lists.made_at, i * d, mine)
        put_real(lists.boxes, i, floor(mine[1] * box.inverse[1]))
        put_real(lists.offsets, i, offset_of_images(box))


@scalar
def bin_solute(i, physics, now, fluid, beads, met):
    """The cell of a bead at t + dt, what it brings there, and its place among the beads there."""
    if now.flags & MEASURE_STRESS:
        tensor = tensor_row(beads, 0, i, physics.zero)
        add_bead_flux(tensor, beads, i, physics, now.box, now.grid.shift)
    bin_bead(beads, i, physics, now)
    put_whole(met.rank, i, take_number(met.count, whole(beads.cell, i), 1))
