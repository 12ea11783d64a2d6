"""What one thread does where solutes act on the fluid by a potential (see `embedded`).

Particles that a bead can reach in a step are put on a list. They fly in the sub-steps of the beads,
in their places in memory. What a particle and a bead hand over is whole numbers, as on the
processor, so that neither the order of the list nor that of threads matters.
"""

from typing import NamedTuple

import numpy as np

from mesokit.devices.device import BLOCK
from mesokit.method.mpcd.engine.beads.interactions import note_for_all
from mesokit.method.mpcd.engine.beads.moving import accelerated
from mesokit.method.mpcd.engine.beads.state import (
    inverse_mass_of,
    load_place,
    load_velocity,
    store_velocity,
)
from mesokit.method.mpcd.engine.beads.verlet import SUBSTEP_BITS, box_after, flown
from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cpu.groups import STREAM
from mesokit.method.mpcd.engine.cpu.physics import has_solid, momentum_scale
from mesokit.method.mpcd.engine.cuda.kernels.beads.solutes import drift_solute
from mesokit.method.mpcd.engine.cuda.kernels.particles import (
    bring,
    collide_particle,
    stream_particle,
)
from mesokit.method.mpcd.engine.cuda.kernels.rows import from_rows, mass_of_number, to_rows
from mesokit.method.mpcd.engine.embedded.flight import (
    floats,
    is_too_hard,
    opposite,
    pull_of,
)
from mesokit.method.mpcd.engine.embedded.near import (
    comes_near,
    has_left,
    mark_around,
    may_be_near,
    path_of,
)
from mesokit.method.mpcd.engine.embedded.readings import energy_units
from mesokit.method.mpcd.engine.embedded.state import (
    ALL_BEADS,
    PARTNERS,
    TOO_FAR,
    TOO_HARD,
    TOO_MANY,
)
from mesokit.scalar.fixed_point import added_quanta, integers
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import (
    add_word,
    add_words,
    clear_words,
    put_real,
    put_reals,
    put_whole,
    real,
    reals,
    take_number,
    whole,
    word,
    words_at,
)
from mesokit.scalar.random import Counter
from mesokit.scalar.vector import added, added_scaled, scaled


class ReachOfBeads(NamedTuple):
    """How far marks around beads reach."""

    reach: float


class NearBeads(NamedTuple):
    """Beads in a fluid that they push away, and the particles near them, by addresses.

    Numbers are those of `Embedded`. candidates (particles,), waiting: particles that may be near a
    bead, and how many. particle, partners (most,), beads (most * PARTNERS,), start (most * d,),
    bound (most,), number: those that are, as in `Embedded`, and how many. origin (beads * d,): the
    places of beads at the start of the step. taken (beads * d,): what they take of particles.
    faults: two numbers, as of bonds that tear.
    """

    potential: tuple
    reach: float
    skin: float
    travel: float
    further: float
    grid: tuple
    marked: int
    lists: ReachOfBeads
    most: int
    candidates: int
    waiting: int
    particle: int
    partners: int
    beads: int
    start: int
    bound: int
    number: int
    origin: int
    taken: int
    faults: int


@scalar
def mark_bead(i, physics, now, fluid, beads, near):
    """Mark the cells around a bead, and keep its place at the start of the step."""
    r = load_place(beads, i, physics.zero)
    put_reals(near.origin, i * len(r), r)
    mark_around(near, r, np.int64(now.counter.step))


@scalar
def sweep_in_fluid(i, physics, now, fluid, near):
    """As `sweep`, but a particle that may be near a bead is only put on a list."""
    r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
    v = collide_particle(i, physics, now, fluid, r, v)
    if now.flags & STREAM:
        mark, step = word(near.marked, cell_index(r, near.grid)), np.int64(now.counter.step)
        if may_be_near(near, physics, mark, step, r, v):
            put_whole(near.candidates, take_number(near.waiting, 0, 1), i)
        else:
            v = stream_particle(i, physics, now, fluid, r, v)
    to_rows(fluid.v, i, v)


@scalar
def choose_candidates(thread, physics, now, fluid, beads, near, threads):
    """List the beads that each candidate may meet; those that meet none fly as all others."""
    for j in range(thread, whole(near.waiting, 0), threads):
        i = whole(near.candidates, j)
        r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
        path = path_of(near, physics, r, v)
        if not meets_any(near, beads, now.box, r, path):
            to_rows(fluid.v, i, stream_particle(i, physics, now, fluid, r, v))
            continue
        n = take_number(near.number, 0, 1)
        if n >= near.most:
            note_for_all(near.faults, np.int64(now.counter.step), TOO_MANY, 0)
            continue
        put_whole(near.particle, n, i)
        put_whole(near.partners, n, list_partners(near, beads, now.box, r, path, n))
        put_real(near.bound, n, max(path, near.travel))
        put_reals(near.start, n * len(r), r)


@scalar
def meets_any(near, beads, box, r, path):
    """Whether a particle at r that flies so far may come within the reach of a bead."""
    met, j = False, 0
    while j < beads.number and not met:
        met = comes_near(near, beads, box, r, path, j)
        j += 1
    return met


@scalar
def list_partners(near, beads, box, r, path, n):
    """List the beads that the nth particle may meet in a flight of length `travel`; how many."""
    found = 0
    if path <= near.travel:
        for j in range(beads.number):
            if comes_near(near, beads, box, r, near.travel, j):
                if found < PARTNERS:
                    put_whole(near.beads, n * PARTNERS + found, j)
                found += 1
    return found if 0 < found <= PARTNERS else ALL_BEADS


@scalar
def drift_in_fluid(i, physics, now, fluid, beads, near, n):
    """Place of a bead after the nth sub-step; a fault if it has gone farther than it may."""
    drift_solute(i, physics, now, fluid, beads, n)
    d = len(physics.zero)
    origin = reals(near.origin, i * d, physics.zero)
    if has_left(origin, load_place(beads, i, physics.zero), near.skin):
        note_for_all(near.faults, np.int64(now.counter.step), TOO_FAR, i + 1)


@scalar
def drift_near(thread, physics, now, fluid, beads, near, threads, n):
    """Straight flight of the particles near beads in the nth sub-step, with reflections."""
    time = physics.timestep / beads.potentials.substeps
    counter = Counter(now.counter.seed, now.counter.step + (n << SUBSTEP_BITS))
    for k in range(thread, min(whole(near.number, 0), near.most), threads):
        i, d = whole(near.particle, k), len(physics.zero)
        r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
        r, v = fly_to(i, physics, time, counter, fluid, r, v)
        to_rows(fluid.r, i, r)
        to_rows(fluid.v, i, v)
        start = reals(near.start, k * d, physics.zero)
        if has_left(start, r, real(near.bound, k)):
            put_whole(near.partners, k, ALL_BEADS)


@by_type
def fly_to(i, physics, time, counter, fluid, r, v):
    """Place and velocity of a particle after a sub-step without forces."""
    if not has_solid(physics):
        return lambda i, physics, time, counter, fluid, r, v: (added_scaled(r, time, v), v)
    return _fly_among_solids


def _fly_among_solids(i, physics, time, counter, fluid, r, v):
    number = whole(fluid.ident, i)
    m = mass_of_number(physics, fluid.kinds, number)
    return flown(physics, time, counter, number, m, r, v, fluid.impulse)


@scalar
def kick_near(thread, physics, now, fluid, beads, near, threads, n):
    """Change of the velocities of particles by the beads near them, which take the opposite."""
    substeps, d = beads.potentials.substeps, len(physics.zero)
    time, scale = physics.timestep / substeps, momentum_scale(physics)
    time = time if n > 0 and n < substeps else 0.5 * time
    box, step = box_after(now, physics, substeps, n), np.int64(now.counter.step)
    for k in range(thread, min(whole(near.number, 0), near.most), threads):
        i, count, given = whole(near.particle, k), whole(near.partners, k), integers(physics.zero)
        r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
        for p in range(count if count != ALL_BEADS else beads.number):
            j = whole(near.beads, k * PARTNERS + p) if count != ALL_BEADS else p
            separation, force_over_r = pull_of(near, beads, box, r, j)
            if force_over_r != 0.0:
                impulse = scaled(time * force_over_r, separation)
                if is_too_hard(impulse, scale):
                    note_for_all(near.faults, step, TOO_HARD, j + 1)
                else:
                    units = added_quanta(impulse, scale, integers(physics.zero))
                    given = added(given, units)
                    add_words(near.taken, j * d, opposite(units))
        m = mass_of_number(physics, fluid.kinds, whole(fluid.ident, i))
        v = added_scaled(v, 1.0 / (scale * m), floats(given))
        to_rows(fluid.v, i, accelerated(physics.field, time, r, v))


@scalar
def take_impulse(i, physics, now, fluid, beads, near):
    """Change of the velocity of a bead by what it takes from particles."""
    zero, start = physics.zero, i * len(physics.zero)
    total, unit = words_at(near.taken, start, zero), 1.0 / momentum_scale(physics)
    clear_words(near.taken, start, zero)
    v = load_velocity(beads, i, zero)
    v = added_scaled(v, unit * inverse_mass_of(beads, i), floats(total))
    store_velocity(beads, i, v)


@scalar
def bring_back(thread, physics, now, fluid, near, threads):
    """Bring the particles near beads into their cells."""
    for k in range(thread, min(whole(near.number, 0), near.most), threads):
        i = whole(near.particle, k)
        r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
        to_rows(fluid.v, i, bring(i, physics, now, fluid, r, v))


@scalar
def add_energy(i, physics, box, fluid, beads, near, scale, sums):
    """Energy of a particle and all beads, in whole units, to the row of its block."""
    r = from_rows(fluid.r, i, physics.zero)
    for j in range(beads.number):
        add_word(sums, i // BLOCK, energy_units(near, beads, box, r, j, scale))
