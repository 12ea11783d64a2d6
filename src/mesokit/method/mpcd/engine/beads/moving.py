"""A sub-step of the beads of solutes: straight flight with reflections, and kicks by forces."""

from typing import Any, NamedTuple

from mesokit.geometry.protocol import Nothing
from mesokit.loops.threads import Worker, barrier
from mesokit.method.mpcd.engine.beads import state
from mesokit.method.mpcd.engine.beads.external import from_outside, turned_by_field
from mesokit.method.mpcd.engine.beads.interactions import BeadForce, Virial
from mesokit.method.mpcd.engine.beads.neighbours import refresh
from mesokit.method.mpcd.engine.beads.traverse import each_on_bead
from mesokit.method.mpcd.engine.beads.verlet import drift, flown, kick
from mesokit.method.mpcd.engine.cpu.physics import field_of, kind_of_solid, momentum_scale
from mesokit.method.mpcd.engine.domains.beads.halo import update_copies
from mesokit.method.mpcd.field.none import Zero
from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.random import FIRST_BEAD
from mesokit.scalar.vector import added_scaled, scaled


class MovingBeads(NamedTuple):
    """The beads from the first to that before the last, and the thread that moves them."""

    worker: Worker
    beads: state.Beads
    first: int
    last: int
    impulse: Any
    measured: int


@drift.register(MovingBeads)
def _(moving, counter, physics, time):
    barrier(moving.worker)  # all threads have read the places at the start of the sub-step
    for n in range(moving.first, moving.last):
        i = state.bead_of(moving.beads.halo, state.OWN, n)
        drift_bead(moving.beads, i, counter, physics, time, moving.impulse)


@by_type
def drift_bead(beads, i, counter, physics, time, impulse):
    """Straight flight, with reflections."""
    return _drift if kind_of_solid(physics) is Nothing else _drift_among_solids


def _drift(beads, i, counter, physics, time, impulse):
    r, v = state.load_place(beads, i, physics.zero), state.load_velocity(beads, i, physics.zero)
    state.store_place(beads, i, added_scaled(r, time, v))


def _drift_among_solids(beads, i, counter, physics, time, impulse):
    r, v = state.load_place(beads, i, physics.zero), state.load_velocity(beads, i, physics.zero)
    r, v = flown(physics, time, counter, FIRST_BEAD + i, state.mass_of(beads, i), r, v, impulse)
    state.store_place(beads, i, r)
    state.store_velocity(beads, i, v)


@kick.register(MovingBeads)
def _(moving, step, box, physics, time):
    beads, still = moving.beads, scaled(0.0, physics.zero)
    force = forces_of_now(moving, step, box, physics, time)
    for n in range(moving.first, moving.last):
        i = state.bead_of(beads.halo, state.OWN, n)
        kick_bead(force, still, beads, i, box, physics, time)


@scalar
def forces_of_now(moving, step, box, physics, time):
    """What finds the force on a bead, once all places are known and lists hold."""
    beads, worker, zero = moving.beads, moving.worker, physics.zero
    barrier(worker)
    update_copies(worker, beads)  # ranks: places of beads near other blocks
    refresh(worker, beads.neighbours, beads.halo, box, beads.r, zero)
    if moving.measured:
        for n in range(moving.first, moving.last):
            i = state.bead_of(beads.halo, state.OWN, n)
            virial = Virial(time, beads.tensor[2, n // state.GROUP], physics.stress_scale)
            each_on_bead(virial, (), beads, i, state.load_place(beads, i, zero), box)
    scale, faults = momentum_scale(physics), beads.faults[worker.thread]
    return BeadForce(time, moving.impulse, scale, step, faults)


@by_type
def kick_bead(action, given, beads, i, box, physics, time):
    """Change of the velocity of a bead by the forces on it, one of which is given."""
    return _kick_from_outside if len(field_of(beads, "external")) else _kick


def _kick(action, given, beads, i, box, physics, time):
    r, v = state.load_place(beads, i, physics.zero), state.load_velocity(beads, i, physics.zero)
    force = each_on_bead(action, given, beads, i, r, box)
    v = added_scaled(v, time * state.inverse_mass_of(beads, i), force)
    state.store_velocity(beads, i, accelerated(physics.field, time, r, v))


def _kick_from_outside(action, given, beads, i, box, physics, time):
    """Half of the change, a turn in the magnetic field, and the other half (Boris 1970)."""
    r, v = state.load_place(beads, i, physics.zero), state.load_velocity(beads, i, physics.zero)
    force = each_on_bead(action, given, beads, i, r, box)
    force = from_outside(beads.external, force, i, r)
    half = 0.5 * time
    v = added_scaled(v, half * state.inverse_mass_of(beads, i), force)
    v = turned_by_field(beads.external, time, i, accelerated(physics.field, half, r, v))
    v = added_scaled(v, half * state.inverse_mass_of(beads, i), force)
    state.store_velocity(beads, i, accelerated(physics.field, half, r, v))


@by_type
def accelerated(field, time, r, v):
    """The velocity after the body force."""
    if field.instance_class is Zero:
        return lambda field, time, r, v: v
    return lambda field, time, r, v: added_scaled(v, time, acceleration(field, r))
