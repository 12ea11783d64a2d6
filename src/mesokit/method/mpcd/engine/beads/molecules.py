"""The flight of the molecules of a fluid through a timestep, WIDTH of them at a time.

Beads fly straight between two kicks, and bounce off solids there; dimers with harmonic bonds may be
moved in closed form instead.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.geometry.protocol import Nothing, touches
from mesokit.loops.layout import LANES, SCRATCH_ROW
from mesokit.loops.threads import Worker
from mesokit.method.mpcd.engine.beads.interactions import Virial, note_broken
from mesokit.method.mpcd.engine.beads.links import Kick, each_link
from mesokit.method.mpcd.engine.beads.registers import WIDTH, bead_at, load_bead, store_bead
from mesokit.method.mpcd.engine.beads.verlet import drift, flown, kick, verlet
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS, FluidMemory
from mesokit.method.mpcd.engine.cpu.near_solids import FEW, forget
from mesokit.method.mpcd.engine.cpu.physics import field_of, has_solid, kind_of_solid
from mesokit.method.mpcd.engine.cpu.stages import clear_of
from mesokit.method.mpcd.engine.cpu.stress import add_product
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.field.none import Zero
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.method.mpcd.molecule import Dimers
from mesokit.method.mpcd.streaming import fall, halfway
from mesokit.potential.protocol import breaks
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import word
from mesokit.scalar.vector import added, added_scaled, chosen, dot, scaled


def has_force(physics: Any) -> bool:
    """Whether there is a body force, from the numba type of `Physics`."""
    return field_of(physics, "field").instance_class is not Zero


class Batch(NamedTuple):
    """The molecules that move: lanes from `start` on of the group whose first strip is `strip`."""

    group: int
    strip: int
    start: int
    lanes: int  # so many of the WIDTH hold molecules


class MovingMolecules(NamedTuple):
    """A batch of molecules of a fluid, and the thread that moves them."""

    worker: Worker
    fluid: FluidMemory
    batch: Batch
    flags: int


@by_type
def fly_molecules(worker, now, physics, fluid, batch):
    """Positions and velocities of beads a timestep later.

    The stress gets, if it is measured, the momentum that bonds hand over; bonds that tear are
    noted.
    """
    molecule = field_of(physics, "molecule")
    return _fly_dimers if molecule.instance_class is Dimers else _fly_springs


def _fly_springs(worker, now, physics, fluid, batch):
    for k in range(physics.molecule.beads):
        bead = fluid.scratch.beads[worker.thread][bead_at(k, physics.zero)]
        remember(physics, bead)
    moving = MovingMolecules(worker, fluid, batch, now.flags)
    verlet(moving, now, physics, physics.molecule.substeps)


@drift.register(MovingMolecules)
def _(moving, counter, physics, time):
    for k in range(physics.molecule.beads):
        if drift_molecule_bead(moving, counter, physics, time, k):
            forget(moving.fluid.room, moving.batch.strip + k, 1 << (moving.batch.start // FEW))


@kick.register(MovingMolecules)
def _(moving, step, box, physics, time):
    molecule, zero, batch, fluid = physics.molecule, physics.zero, moving.batch, moving.fluid
    work = fluid.scratch.beads[moving.worker.thread]
    if moving.flags & MEASURE_STRESS:
        virial = Virial(time, fluid.taken.tensor[2, batch.group], physics.stress_scale)
        each_link(virial, molecule, work, batch.lanes, zero)
    change = Kick(time * molecule.inverse_mass)
    if each_link(change, molecule, work, WIDTH, zero):
        note_broken_bonds(moving, step, molecule, zero)
    for k in range(molecule.beads):
        accelerate_bead(physics, time, work[bead_at(k, zero)])


@where(physics=has_force)
def accelerate_bead(physics, time, bead):
    """The body force, if there is one."""
    zero = physics.zero
    for i in range(WIDTH):
        r, v = load_bead(bead, i, 0, zero), load_bead(bead, i, len(zero), zero)
        v = added_scaled(v, time, acceleration(physics.field, r))
        store_bead(bead, i, len(zero), v)


def _fly_dimers(worker, now, physics, fluid, batch):
    work, zero = fluid.scratch.beads[worker.thread], physics.zero
    d = len(zero)
    a, b = work[bead_at(0, zero)], work[bead_at(1, zero)]
    if now.flags & MEASURE_STRESS:
        _exact_virial(physics, a, b, batch.lanes, fluid.taken.tensor[2, batch.group])
    for i in range(WIDTH):
        r, v = load_bead(a, i, 0, zero), load_bead(a, i, d, zero)
        r2, v2 = load_bead(b, i, 0, zero), load_bead(b, i, d, zero)
        r, v, r2, v2 = swung(physics, r, v, r2, v2)
        store_bead(a, i, 0, r + v)
        store_bead(b, i, 0, r2 + v2)


@scalar
def swung(physics, r, v, r2, v2):
    """Closed form of a timestep, t -> t + dt, of both beads of a dimer.

    The centre of mass falls freely; the separation of the beads is a harmonic oscillator.
    """
    exact, time = physics.molecule, physics.timestep
    separation, rate = added_scaled(r2, -1.0, r), added_scaled(v2, -1.0, v)
    centre, rise = scaled(0.5, added(r, r2)), scaled(0.5, added(v, v2))
    pull = halfway(physics.field, centre, rise, time)
    centre, rise = fall(centre, rise, pull, time)
    half = scaled(0.5, added_scaled(scaled(exact.cosine, separation), exact.late, rate))
    turn = scaled(0.5, added_scaled(scaled(exact.cosine, rate), exact.early, separation))
    first = added_scaled(centre, -1.0, half), added_scaled(rise, -1.0, turn)
    return first + (added(centre, half), added(rise, turn))


@scalar
def _exact_virial(physics, a, b, lanes, tensor):
    """Add the momentum that harmonic bonds hand over in a timestep."""
    zero, d = physics.zero, len(physics.zero)
    for i in range(lanes):
        separation = added_scaled(load_bead(b, i, 0, zero), -1.0, load_bead(a, i, 0, zero))
        rate = added_scaled(load_bead(b, i, d, zero), -1.0, load_bead(a, i, d, zero))
        add_swing(physics, separation, rate, tensor)


@scalar
def add_swing(physics, separation, rate, tensor):
    """Add that of one bond: -2K times the time integral of the outer product of the vector between
    the beads with itself."""
    exact, scale = physics.molecule, physics.stress_scale
    add_product(tensor, scale, exact.separations, separation, separation)
    add_product(tensor, scale, exact.mixed, separation, rate)
    add_product(tensor, scale, exact.mixed, rate, separation)
    add_product(tensor, scale, exact.rates, rate, rate)


@where(physics=has_solid)
def remember(physics, bead):
    """Keep the places from which the timestep started, for the search of solids."""
    for i in range(WIDTH):
        store_bead(bead, i, 2 * len(physics.zero), load_bead(bead, i, 0, physics.zero))


@by_type
def drift_molecule_bead(moving, counter, physics, time, k):
    """Straight flight of bead k, with reflections; whether any of the batch came near a solid."""
    return _drift if kind_of_solid(physics) is Nothing else _drift_among_solids


def _drift(moving, counter, physics, time, k):
    zero = physics.zero
    d, bead = len(zero), moving.fluid.scratch.beads[moving.worker.thread][bead_at(k, zero)]
    for i in range(WIDTH):
        r, v = load_bead(bead, i, 0, zero), load_bead(bead, i, d, zero)
        store_bead(bead, i, 0, added_scaled(r, time, v))
    return False


def _drift_among_solids(moving, counter, physics, time, k):
    batch, fluid, thread, zero = moving.batch, moving.fluid, moving.worker.thread, physics.zero
    d, rest, bead = len(zero), scaled(0.0, zero), fluid.scratch.beads[thread][bead_at(k, zero)]
    clear = fluid.scratch.clear[thread, k * SCRATCH_ROW + batch.start : (k + 1) * SCRATCH_ROW]
    hits, impulse = fluid.scratch.marks[thread], fluid.taken.impulse[thread]
    any_hit = np.int64(0)
    # A sub-step as vectors: beads that may hit a surface stay behind, as in `stages.fly`. The clear
    # distance is that around the place at the start of the timestep, so the whole displacement from
    # there counts. The second loop moves them, with reflections.
    for i in range(WIDTH):
        r, v = load_bead(bead, i, 0, zero), load_bead(bead, i, d, zero)
        there, start = added_scaled(r, time, v), load_bead(bead, i, 2 * d, zero)
        moved = added_scaled(there, -1.0, start)
        around = clear_of(physics.solid, clear, i)
        hit = np.int64(touches(physics.solid, around, start, moved, rest, 1.0))
        hits[i] = hit
        any_hit |= hit
        store_bead(bead, i, 0, chosen(hit != 0, r, there))
    if any_hit == 0:
        return False
    numbers, (m,) = fluid.particles.ident[(batch.strip + k) * LANES + batch.start :], physics.masses
    for i in range(batch.lanes):
        if hits[i] != 0:
            r, v = load_bead(bead, i, 0, zero), load_bead(bead, i, d, zero)
            r, v = flown(physics, time, counter, numbers[i], m, r, v, impulse)
            store_bead(bead, i, 0, r + v)
    return True


@scalar
def note_broken_bonds(moving, step, molecule, zero):
    """Find the bonds that are longer than their potential allows (seldom called)."""
    batch, ident, thread = moving.batch, moving.fluid.particles.ident, moving.worker.thread
    work, faults = moving.fluid.scratch.beads[thread], moving.fluid.taken.faults[thread]
    (bonds, _, _), base = molecule.number, batch.strip * LANES + batch.start
    # The kick only shows that some bond of the batch is broken, or of its spare lanes. Here broken
    # bonds are found one by one, with the ids of their beads.
    for n in range(bonds):
        one, other = word(molecule.links, 2 * n), word(molecule.links, 2 * n + 1)
        a, b = work[bead_at(one, zero)], work[bead_at(other, zero)]
        for i in range(batch.lanes):
            separation = added_scaled(load_bead(b, i, 0, zero), -1.0, load_bead(a, i, 0, zero))
            if breaks(molecule.bond, dot(separation, separation)):
                first, second = ident[base + one * LANES + i], ident[base + other * LANES + i]
                note_broken(faults, step, first, second)
