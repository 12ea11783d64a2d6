"""Beads of solutes: their flight through a timestep, and their part in the collisions.

Springs by velocity Verlet, as for fluids of molecules: half a kick, then a drift and a kick for
each sub-step, the last kick a half one. Beads keep the image that they started in: bonds are plain
differences. Each bead adds up the forces on it in one order, so that threads share the beads
without sharing sums; few beads are one thread's.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.box import at_time, fold, unfold
from mesokit.execute.bounce import bounce, take
from mesokit.execute.cache import inner
from mesokit.execute.flags import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.execute.layout import record_length, share
from mesokit.execute.neighbours import CROWDED, apart, refresh
from mesokit.execute.rows import fetch, put
from mesokit.execute.solute_stress import add_bead_virial, add_flux
from mesokit.execute.stages import cell_index, in_cell, kind_of_solid
from mesokit.execute.team import wait
from mesokit.execute.verlet import SUBSTEP_BITS, within
from mesokit.geometry.none import Nothing
from mesokit.geometry.protocol import facing, free
from mesokit.mpcd.collision.protocol import collide, contribute
from mesokit.mpcd.field.none import Zero
from mesokit.mpcd.field.protocol import acceleration
from mesokit.mpcd.streaming import fall
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central, torn
from mesokit.random import Counter
from mesokit.scalar import added, added_scaled, by_type, dot, scalar, scaled

GROUP = 64  # beads whose part in the stress is added up by itself
LEAST = 4  # groups for a thread: fewer do not pay for the gate
FIRST_NUMBER = 2**31  # of a bead in random streams, beyond those of all particles


class SoluteState(NamedTuple):
    """Beads, what holds them, and memory for a step.

    mass: of a bead; potentials: of type `Potentials`; neighbours: (Neighbours,) or ().
    r, v (beads * d,): places, whole molecules in one image, and velocities there.
    bond_starts (beads + 1,), bonds: to whom each bead is linked.
    angle_starts (beads + 1,), angles (n, 4): the angles that each bead is in, and as which bead.
    near_wall: (solid, distance) for the potential of walls, or ().
    faults (threads, 8): step and beads of the first bond that tore.
    cell (beads,): of the grid; head (cells,), following (beads,): the beads of each cell.
    given: what each bead adds to the sums of its cell, as long as `terms`, side by side.
    answers: what the cells of beads need to collide; leads (beads,): whose cell has one.
    solvent: (mean number, mass of a particle) for random solvent, or ().
    tensor (3, groups, 2 d d): what groups of beads add to the stress (see `solute_stress`): before
    and after the collision, and by forces.
    """

    mass: float
    potentials: tuple
    neighbours: tuple
    r: Any
    v: Any
    bond_starts: Any
    bonds: Any
    angle_starts: Any
    angles: Any
    near_wall: tuple
    faults: Any
    cell: Any
    head: Any
    following: Any
    given: Any
    terms: tuple[float, ...]
    answers: Any
    leads: Any
    solvent: tuple
    tensor: Any


@by_type
def move_solutes(solutes, *rest):
    """Do what the flags ask: the pending collision, the flight, the cells (see `sweep`)."""
    return _move if len(solutes) else lambda *_: None


def _move(
    solutes, thread, threads, gate, what, physics, box, counter, old, grid, coefficients, impulse,
    like, c, scales,
):  # fmt: skip
    move_beads(
        solutes, thread, threads, gate, what, physics, box, counter, old, grid, coefficients,
        impulse, like, c, scales,
    )  # fmt: skip


@inner
def move_beads(
    solutes, thread, threads, gate, what, physics, box, counter, old, grid, coefficients, impulse,
    like, c, scales,
):  # fmt: skip
    groups = (len(solutes.cell) + GROUP - 1) // GROUP
    together = threads if groups >= LEAST * threads else 1
    if thread >= together:
        return
    first, last = share(groups, thread, together)
    first, last = first * GROUP, min(last * GROUP, len(solutes.cell))
    measured = what & MEASURE_STRESS
    if what & COLLIDE:  # v: the collision at t
        now = at_time(box, (counter.step - (1 if what & STREAM else 0)) * physics.timestep)
        for i in range(first, last):
            collide_bead(solutes, i, physics, now, old, coefficients, like, c)
        if measured and not what & STREAM:
            for i in range(first, last):
                add_flux(solutes, i, box, old.shift, solutes.tensor[1, i // GROUP], like)
    if what & STREAM:  # r, v: t -> t + dt; cells at t + dt
        fly_beads(
            solutes, thread, together, gate, physics, box, counter, impulse, first, last, measured,
            like, scales,
        )  # fmt: skip
        if measured:
            for i in range(first, last):
                add_flux(solutes, i, box, grid.shift, solutes.tensor[0, i // GROUP], like)
        for i in range(first, last):
            bin_bead(solutes, i, physics, box, counter, grid, like)


@scalar
def collide_bead(solutes, i, physics, box, grid, coefficients, like, c):
    """Velocity after the collision in its cell."""
    at = np.uint64(i * len(like))
    r, v, boxes = fold(box, fetch(solutes.r, at, like), fetch(solutes.v, at, like), grid.shift)
    start = np.uint64(solutes.cell[i]) * np.uint64(record_length(len(c)))
    v = collide(physics.rule, fetch(coefficients, start, c), v, in_cell(r, grid))
    put(solutes.v, at, unfold(box, r, v, boxes)[1])


@scalar
def bin_bead(solutes, i, physics, box, counter, grid, like):
    """The cell of a bead, and what it adds to the sums of that cell."""
    at, m = np.uint64(i * len(like)), solutes.mass
    r, v, boxes = fold(box, fetch(solutes.r, at, like), fetch(solutes.v, at, like), grid.shift)
    solutes.cell[i] = cell_index(r, grid)
    who = (FIRST_NUMBER + i, 0)
    kept, own = contribute(physics.rule, counter, who, m, v, in_cell(r, grid))
    put(solutes.v, at, unfold(box, r, kept, boxes)[1])
    terms = scaled(m, v) + (m * dot(v, v),) + own
    put(solutes.given, np.uint64(i * len(terms)), terms)


@scalar
def fly_beads(
    solutes, thread, threads, gate, physics, box, counter, impulse, first, last, measured, like,
    scales,
):  # fmt: skip
    """Places and velocities a timestep later."""
    substeps = solutes.potentials.substeps
    time = physics.timestep / substeps
    short = within(physics, time)
    for n in range(substeps + 1):
        if n > 0:  # r: t + (n - 1) h -> t + n h
            wait(gate, threads)  # nobody looks at the places before any more
            at = Counter(counter.seed, counter.step + (n << SUBSTEP_BITS))
            for i in range(first, last):
                drift_bead(solutes, i, short, at, impulse, like, scales)
        now = at_time(box, (counter.step - 1) * physics.timestep + n * time)
        wait(gate, threads)
        refresh(solutes.neighbours, now, thread, threads, gate, solutes.r, first, last, like)
        # v: the second half of the kick of that sub-step, and the first half of the next one's
        span = time if 0 < n < substeps else 0.5 * time
        if measured:
            for i in range(first, last):
                add_bead_virial(solutes, i, now, span, solutes.tensor[2, i // GROUP], like)
        for i in range(first, last):
            kick_bead(solutes, i, physics, now, span, counter.step, thread, impulse, like, scales)


@by_type
def drift_bead(solutes, i, short, counter, impulse, like, scales):
    """Straight flight through a sub-step, with reflections."""
    return _drift if kind_of_solid(short) is Nothing else _drift_among_solids


def _drift(solutes, i, short, counter, impulse, like, scales):
    at = np.uint64(i * len(like))
    r, v = fetch(solutes.r, at, like), fetch(solutes.v, at, like)
    put(solutes.r, at, added_scaled(r, short.timestep, v))


def _drift_among_solids(solutes, i, short, counter, impulse, like, scales):
    at, solid, time, rest = np.uint64(i * len(like)), short.solid, short.timestep, scaled(0.0, like)
    r, v = fetch(solutes.r, at, like), fetch(solutes.v, at, like)
    if free(solid, r, v, rest, time):
        r, v = fall(r, v, rest, time)
    else:
        number = FIRST_NUMBER + i
        r, v = bounce(short, counter, number, solutes.mass, r, v, rest, impulse, scales[0])
    put(solutes.r, at, r)
    put(solutes.v, at, v)


@scalar
def kick_bead(solutes, i, physics, box, time, step, thread, impulse, like, scales):
    """Change of the velocity of a bead by the forces on it, kept for a time."""
    at = np.uint64(i * len(like))
    r, v = fetch(solutes.r, at, like), fetch(solutes.v, at, like)
    force = scaled(0.0, like)
    force = added(force, bond_force(solutes.potentials.bond, solutes, i, r, step, thread, like))
    force = added(force, angle_force(solutes.potentials.angle, solutes, i, like))
    force = added(force, pair_force(solutes.potentials.pair, solutes, i, box, r, like))
    wall = wall_force(solutes.potentials.wall, solutes, r, time, impulse, like, scales)
    force = added(force, wall)
    v = added_scaled(v, time * solutes.potentials.inverse_mass, force)
    put(solutes.v, at, pushed(physics.field, time, r, v))


@by_type
def pushed(field, time, r, v):
    """The velocity after the body force."""
    if field.instance_class is Zero:
        return lambda field, time, r, v: v
    return lambda field, time, r, v: added_scaled(v, time, acceleration(field, r))


@by_type
def bond_force(bond, solutes, i, r, step, thread, like):
    """Of all bonds of bead i."""
    return _bond_force if len(bond) else _no_bond


def _no_bond(bond, solutes, i, r, step, thread, like):
    return scaled(0.0, like)


def _bond_force(bond, solutes, i, r, step, thread, like):
    force = scaled(0.0, like)
    for n in range(solutes.bond_starts[i], solutes.bond_starts[i + 1]):
        j = solutes.bonds[n]
        way = added_scaled(r, -1.0, fetch(solutes.r, np.uint64(j * len(like)), like))
        square = dot(way, way)
        _, push = central(bond[0], square)
        force = added_scaled(force, push, way)
        if torn(bond[0], square):
            note_torn(solutes.faults, thread, step, i, j)
    return force


@scalar
def note_torn(faults, thread, step, i, j):
    """Note step and beads of the first bond that is longer than it can be (seldom called)."""
    one, other, at = np.int64(min(i, j)), np.int64(max(i, j)), np.int64(step)
    earlier = faults[thread, 0] == 0 or at < faults[thread, 0]
    if earlier or (at == faults[thread, 0] and one < faults[thread, 1]):
        faults[thread, 0], faults[thread, 1], faults[thread, 2] = at, one, other


@by_type
def angle_force(angle, solutes, i, like):
    """Of all angles that bead i is in."""
    return _angle_force if len(angle) else lambda angle, solutes, i, like: scaled(0.0, like)


def _angle_force(angle, solutes, i, like):
    force, d = scaled(0.0, like), len(like)
    for n in range(solutes.angle_starts[i], solutes.angle_starts[i + 1]):
        a = fetch(solutes.r, np.uint64(solutes.angles[n, 0] * d), like)
        b = fetch(solutes.r, np.uint64(solutes.angles[n, 1] * d), like)
        c = fetch(solutes.r, np.uint64(solutes.angles[n, 2] * d), like)
        _, first, last = bend(angle[0], added_scaled(b, -1.0, a), added_scaled(c, -1.0, b))
        role = solutes.angles[n, 3]
        middle = scaled(-1.0, added(first, last))
        own = first if role == 0 else (last if role == 2 else middle)
        force = added(force, own)
    return force


@by_type
def pair_force(pair, solutes, i, box, r, like):
    """Of all beads near bead i."""
    return _pair_force if len(pair) else lambda pair, solutes, i, box, r, like: scaled(0.0, like)


def _pair_force(pair, solutes, i, box, r, like):
    lists, force, d = solutes.neighbours[0], scaled(0.0, like), len(like)
    count = lists.count[i]
    for n in range(count if count != CROWDED else len(lists.count)):
        j = lists.near[i, n] if count != CROWDED else n
        way = apart(box, fetch(solutes.r, np.uint64(j * d), like), r)
        _, push = central(pair[0], dot(way, way))
        push = push if j != i else 0.0
        force = added_scaled(force, push, way)
    return force


@by_type
def wall_force(wall, solutes, r, time, impulse, like, scales):
    """Of the nearest surface, which takes the opposite momentum."""
    return _wall_force if len(wall) else _no_wall


def _no_wall(wall, solutes, r, time, impulse, like, scales):
    return scaled(0.0, like)


def _wall_force(wall, solutes, r, time, impulse, like, scales):
    solid, reach = solutes.near_wall
    distance, out, surface, lever = facing(solid, reach, r)
    force = scaled(0.0, like)
    if distance < reach:
        _, push = central(wall[0], distance * distance)
        force = scaled(push * distance, out)
        take(impulse, surface, lever, scaled(-time, force), scales[0])
    return force
