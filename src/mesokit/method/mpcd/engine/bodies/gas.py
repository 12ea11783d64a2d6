"""Virtual particles in the cells that bodies cut: the gas of a body.

The gas has the density of the fluid and moves with the body. In a cell that a ball cuts it is drawn
together, as `virtual.per_cell` does for walls; in others, and for rules that conserve angular
momentum, particles are drawn one by one. What the body's own rigid motion
already has of the thermal noise is taken out of the drawn velocities. So body and gas have the
thermal noise of the body once, and its temperature is exact.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.case.box import SLIDING, fold
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, LAST_LANE, SCRATCH_ROW, record_length, share, sums_length
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.collision.protocol import collide
from mesokit.method.mpcd.engine.bodies.hits import (
    add_moments,
    moments_at,
    no_moments,
    physics_scales,
    take_impulses,
    wall_velocity,
)
from mesokit.method.mpcd.engine.bodies.linear import solve_noise, unlevered
from mesokit.method.mpcd.engine.bodies.near import slides
from mesokit.method.mpcd.engine.bodies.search import normal_at
from mesokit.method.mpcd.engine.bodies.state import (
    B1,
    B2,
    BATCHED,
    CHANGE,
    FILLED,
    FOUR,
    GAS_ARM,
    GAS_COUNT,
    GAS_INNER,
    GAS_KEPT,
    GAS_MASS,
    GAS_PLACE,
    GAS_SPEED,
    GAS_VELOCITY,
    IS_BALL,
    PLACE,
    RADIUS,
    THREE,
    TURN,
    add_threads,
    is_nearer,
    load,
    of_kind,
    store,
    swept,
    with_shear,
)
from mesokit.method.mpcd.engine.bodies.stress import (
    AFTER,
    BEFORE,
    add_body_flux,
    add_gas_gain,
)
from mesokit.method.mpcd.engine.cpu.grid import cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.groups import MEASURE_STRESS
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale, of_bodies, of_gas
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import needs_energy
from mesokit.method.mpcd.engine.cpu.strips.rows import (
    add_values,
    load_scratch,
    load_values,
    store_scratch,
)
from mesokit.method.mpcd.engine.domains.messages.bodies import add_others, is_own_cell
from mesokit.method.mpcd.engine.domains.messages.shared import key_of
from mesokit.method.mpcd.engine.embedded.near import note
from mesokit.method.mpcd.engine.embedded.state import TOO_MANY
from mesokit.method.mpcd.engine.virtual.of_cell import Many, brought_by_many, cut_at
from mesokit.method.mpcd.engine.virtual.per_cell import MEAN, NUMBER, THERMAL, count_batch
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.fixed_point import add_integers, added_quanta, floats, integers
from mesokit.scalar.gamma import gamma_number, likely
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.poisson import poisson_number
from mesokit.scalar.prefetch import prefetch
from mesokit.scalar.random import (
    BODY_GAS_NUMBER,
    BODY_GAS_PLACE,
    BODY_GAS_VELOCITY,
    FIRST_BODY_GAS,
    normals,
    unit_open,
    words,
)
from mesokit.scalar.vector import added, added_scaled, chosen, dot, first, outer, scaled

MOST_OF_CELL = 2**10  # virtual particles of a body in a cell: more never come
MOST_DRAWS = 256  # of a place in the part of a cell that is in a ball
AHEAD = 8  # entries of the gas
VECTOR = 8  # numbers of the longest vectors
HALF_DIAGONAL = 0.5 * math.sqrt(3.0)
# Rows of a batch of cells beside those of `virtual.per_cell`. Places and velocities have three.
# Cells that wait for a place have columns of their own; WAITING: the row of their keys.
GAS_AT, MIDDLE, CENTRE, BALL, SPEED = 0, 13, 16, 19, 20
WAITING_MIDDLE, WAITING_CENTRE, WAITING = 21, 24, 3


@stage
def draw_all_gas(worker, now, physics, fluid, bodies):
    """Draw the gas of all bodies at t + dt, and add it to the sums of its cells."""
    thread, here = worker.thread, bodies.counters[worker.thread]
    here[GAS_COUNT] = here[BATCHED] = 0
    if now.flags & MEASURE_STRESS:
        add_body_flux(worker, physics, now, bodies, BEFORE)
    # First the gas of this thread's part of each body: places, thermal velocities, and the sums
    # that say how much of their noise is that of the body. A body is solved by one thread. Then
    # each thread completes its own particles and adds them to its own sums of cells.
    for i in range(len(bodies.rows)):
        if of_kind(bodies, i, FILLED) > 0.0:
            for copy in range(3 if slides(now.box) else 1):
                up = copy - 1 if slides(now.box) else 0
                draw_gas(worker, now, of_gas(physics), fluid, bodies, i, up)
    draw_cells_of_balls(thread, now.counter, of_gas(physics), bodies)
    barrier(worker)
    add_others(worker, bodies, bodies.sums, 0)
    low, high = share(len(bodies.rows), thread, worker.threads)
    for i in range(low, high):
        take_noise(worker, of_bodies(physics), bodies, i)
    barrier(worker)
    bodies.sums[thread] = 0
    sums, length = fluid.cells.sums[thread], sums_length(len(physics.terms))
    for n in range(here[GAS_COUNT]):  # sums of cells are fetched some entries ahead
        ahead = np.int64(bodies.gas_cell[thread, min(n + AHEAD, here[GAS_COUNT] - 1)])
        prefetch(sums, ahead * length, 0)
        move_gas(thread, now, physics, fluid, bodies, n)


@seldom
def draw_gas(worker, now, physics, fluid, bodies, i, copy):
    """The gas in this thread's layers of cells around body i; of images `copy` boxes up."""
    zero, grid, d, box = physics.zero, now.grid, len(physics.zero), now.box
    x, radius = load(bodies.rows, i, PLACE, zero), of_kind(bodies, i, RADIUS)
    x, u = image_up(box, x, zero, copy)
    speed = u[0]
    low, high = zero, zero
    for k in range(d):
        low = with_item(low, k, floor(x[k] - radius + grid.origin[k]))
        high = with_item(high, k, floor(x[k] + radius + grid.origin[k]))
    if slides(box):  # cells across an end are those of other images
        low = with_item(low, 1, max(low[1], 0.0))
        high = with_item(high, 1, min(high[1], grid.cells[1] - 1.0))
    layers = max(int(high[d - 1] - low[d - 1]) + 1, 0)
    # Layers are dealt to threads from another one on for each body.
    turn = (worker.thread + i) % worker.threads
    begin, end = share(layers, turn, worker.threads)
    middle = zero
    for c in range(begin, end):
        middle = with_item(middle, d - 1, low[d - 1] + c + 0.5 - grid.origin[d - 1])
        for b in range(int(high[1] - low[1]) + 1 if d == 3 else 1):
            if d == 3:
                middle = with_item(middle, 1, low[1] + b + 0.5 - grid.origin[1])
            for a in range(int(high[0] - low[0]) + 1):
                middle = with_item(middle, 0, low[0] + a + 0.5 - grid.origin[0])
                if not is_own_cell(fluid.cells.shared, grid, middle):
                    continue
                if is_cut(bodies, i, added_scaled(middle, -1.0, x)):
                    at = GasCell(i, x, speed, middle, np.int64(cell_index(middle, grid)))
                    key = np.int64(key_of(fluid.cells.shared, at.cell))
                    fill_cell_of_body(worker, now, physics, bodies, at, key)


@where("(x, zero)", box=lambda box: box.instance_class in SLIDING)
def image_up(box, x, zero, copy):
    """The image of x so many boxes up, and its velocity."""
    x = with_item(x, 1, x[1] + copy * box.size[1])
    x = with_item(x, 0, x[0] + copy * box.offset)
    return x, with_shear(zero, copy * box.speed)


@scalar
def is_cut(bodies, i, s):
    """Whether the surface may cut the cell whose middle is at an arm."""
    reach = of_kind(bodies, i, RADIUS) + HALF_DIAGONAL
    if dot(s, s) > reach * reach:
        return False
    if of_kind(bodies, i, IS_BALL) > 0.5:
        within = reach - 2.0 * HALF_DIAGONAL
        return within < 0.0 or dot(s, s) >= within * within
    q = load(bodies.rows, i, TURN, FOUR)
    kind = bodies.kind[i]
    near = is_nearer(bodies, kind, q, s, HALF_DIAGONAL)
    return near and not is_nearer(bodies, kind, q, s, -HALF_DIAGONAL)


class GasCell(NamedTuple):
    """A cell that a body cuts: the number of the body, its centre, the speed of this image along
    x, the middle of the cell, and the number of the cell."""

    body: int
    centre: tuple
    speed: float
    middle: tuple
    cell: np.int64


@seldom
def fill_cell_of_body(worker, now, physics, bodies, at, cell_key):
    """The gas of body i in a cell; all of a cell that a ball cuts waits for its batch."""
    key = np.int64(at.body) * np.int64(bodies.cells + 1) + cell_key
    if bodies.together == 1 and of_kind(bodies, at.body, IS_BALL) > 0.5:
        put_in_batch(worker.thread, bodies, at, key)
        if bodies.counters[worker.thread, BATCHED] == LANES:
            draw_cells_of_balls(worker.thread, now.counter, physics, bodies)
        return
    found = gas_one_by_one(worker.thread, now.counter, physics, bodies, at, key)
    # The terms of a cell are added before they are rounded, in the order in which they were drawn.
    add_moments(
        bodies.sums[worker.thread, at.body], found, at.middle, physics_scales(bodies, physics)
    )


# --- all of a cell at once ------------------------------------------------------------------------


@scalar
def put_in_batch(thread, bodies, at, key):
    """Put a cell that a ball cuts in the batch of this thread."""
    work, keys, n = bodies.columns[thread], bodies.keys[thread], bodies.counters[thread, BATCHED]
    store_scratch(work, MIDDLE * SCRATCH_ROW + n, at.middle)
    store_scratch(work, CENTRE * SCRATCH_ROW + n, at.centre)
    work[BALL * SCRATCH_ROW + n] = of_kind(bodies, at.body, RADIUS)
    work[MEAN * SCRATCH_ROW + n] = mean_gas(bodies, at.body)
    work[SPEED * SCRATCH_ROW + n] = at.speed
    keys[0, n], keys[1, n], keys[2, n] = key, at.cell, at.body
    bodies.counters[thread, BATCHED] = n + 1


@seldom
def draw_cells_of_balls(thread, counter, physics, bodies):
    """All particles of the gas in each cell of a batch as one, as heavy as they are.

    The place is that of one of them: with the mean place, the gas would have too little of a moment
    of inertia, by 8 % of its own at a radius of 2.
    """
    work, keys, zero = bodies.columns[thread], bodies.keys[thread], physics.zero
    count, scales = bodies.counters[thread, BATCHED], physics_scales(bodies, physics)
    bodies.counters[thread, BATCHED] = 0
    # Mean numbers, numbers, places and thermal velocities of all cells in loops that become
    # vectors; then the entries one by one. All follow from the key of the cell alone, so it does
    # not matter which cells a batch has.
    for j in range(LANES):
        centre = load_scratch(work, CENTRE * SCRATCH_ROW + j, zero)
        away = added_scaled(load_scratch(work, MIDDLE * SCRATCH_ROW + j, zero), -1.0, centre)
        mean, place = mean_in_ball(work[MEAN * SCRATCH_ROW + j], work[BALL * SCRATCH_ROW + j], away)
        work[MEAN * SCRATCH_ROW + j] = mean if j < count else 0.0
        store_scratch(work, GAS_AT * SCRATCH_ROW + j, place)
    count_batch(keys[0], counter, BODY_GAS_NUMBER, work)
    place_batch(counter, work, keys, bodies.chosen[thread], count, zero)
    for j in range(LANES):
        m = bodies.gas_mass * max(work[NUMBER * SCRATCH_ROW + j], 1.0)
        thermal = thermal_noise(counter, physics, keys[0, j], 0, m)
        store_scratch(work, THERMAL * SCRATCH_ROW + j, thermal)
    for j in range(count):
        number, key = int(work[NUMBER * SCRATCH_ROW + j]), keys[0, j]
        if number > 0:
            centre = load_scratch(work, CENTRE * SCRATCH_ROW + j, zero)
            at = GasCell(keys[2, j], centre, work[SPEED * SCRATCH_ROW + j], centre, keys[1, j])
            s = load_scratch(work, GAS_AT * SCRATCH_ROW + j, zero)
            v = load_scratch(work, THERMAL * SCRATCH_ROW + j, zero)
            inner = inner_energy(counter, physics, key, number)
            found = put_gas(thread, counter, bodies, at, GasDraw(key, 0, number, s, v, inner))
            add_moments(bodies.sums[thread, at.body], found, zero, scales)


@scalar
def place_batch(counter, work, keys, waiting, count, zero):
    """A uniform place in the ball for each cell with particles: draws until it lies there."""
    left, draw = 0, 0
    for j in range(count):
        if work[NUMBER * SCRATCH_ROW + j] > 0.5:
            wait_for_place(work, keys, waiting, j, left & LAST_LANE, zero)
            left += 1
    # Cells that wait are the first entries of columns of their own, so that each draw is one loop
    # over vectors, which are whole. Those that have found a place leave these columns.
    while left > 0 and draw < MOST_DRAWS:
        for n in range((left + VECTOR - 1) // VECTOR * VECTOR):
            middle = load_scratch(work, WAITING_MIDDLE * SCRATCH_ROW + n, zero)
            centre = load_scratch(work, WAITING_CENTRE * SCRATCH_ROW + n, zero)
            s = added_scaled(uniform_place(counter, middle, keys[WAITING, n], draw), -1.0, centre)
            store_scratch(work, THERMAL * SCRATCH_ROW + n, s)
        still = 0
        for n in range(left):  # no branches, as none could be predicted
            s, j = load_scratch(work, THERMAL * SCRATCH_ROW + n, zero), waiting[n] & LAST_LANE
            inside = dot(s, s) < work[BALL * SCRATCH_ROW + j] * work[BALL * SCRATCH_ROW + j]
            before = load_scratch(work, GAS_AT * SCRATCH_ROW + j, zero)
            store_scratch(work, GAS_AT * SCRATCH_ROW + j, chosen(inside, s, before))
            wait_for_place(work, keys, waiting, j, still & LAST_LANE, zero)
            still += 0 if inside else 1
        left, draw = still, draw + 1


@scalar
def wait_for_place(work, keys, waiting, j, n, zero):
    """Put a cell of the batch in column n of those that wait for a place."""
    for row in (MIDDLE, CENTRE):
        values = load_scratch(work, row * SCRATCH_ROW + j, zero)
        store_scratch(work, (row - MIDDLE + WAITING_MIDDLE) * SCRATCH_ROW + n, values)
    waiting[n], keys[WAITING, n] = j, keys[0, j]


@scalar
def mean_in_ball(density, radius, away):
    """Mean number of particles in the part of a cell that is in a ball, and the mean arm there, by
    the arm of the middle of the cell. None where all of the cell is in the ball.

    A plane stands for the sphere. It lies as deep as the sphere does on the mean over the cell.
    """
    far, sunk = math.sqrt(dot(away, away)), (len(away) - 1) / (24.0 * radius)
    normal = scaled(1.0 / max(far, 1e-9), away)
    mean, _, place = cut_at(density, far - radius + sunk, normal, away, scaled(0.0, away))
    return mean, place


# --- one by one -----------------------------------------------------------------------------------


@scalar
def gas_one_by_one(thread, counter, physics, bodies, at, key):
    """Particles at places of an ideal gas, of which those in the body are kept; their moments."""
    found, mean = no_moments(at.middle), mean_gas(bodies, at.body)
    kind, q = bodies.kind[at.body], load(bodies.rows, at.body, TURN, FOUR)
    for j in range(poisson_number(mean, counter, BODY_GAS_NUMBER, key)):
        s = added_scaled(uniform_place(counter, at.middle, key, j), -1.0, at.centre)
        if is_nearer(bodies, kind, q, s, 0.0):
            thermal = thermal_noise(counter, physics, key, j, bodies.gas_mass)
            drawn = GasDraw(key, j, 1, s, thermal, 0.0)
            found = added(found, put_gas(thread, counter, bodies, at, drawn))
    return found


@scalar
def mean_gas(bodies, i):
    """Mean number of particles of the gas of body i in a cell within it."""
    return bodies.density * of_kind(bodies, i, FILLED)


class GasDraw(NamedTuple):
    """Particles of the gas: key of their cell, number of the first, how many, their arm, mean
    thermal velocity, and the sum of m v^2 about that."""

    key: np.int64
    draw: int
    number: int
    arm: tuple
    thermal: tuple
    inner: float


@scalar
def thermal_noise(counter, physics, key, draw, m):
    """Thermal velocity of a draw of a cell, of a mass."""
    a, b, c, e = words(counter, BODY_GAS_VELOCITY, key, draw)
    return scaled(math.sqrt(physics.kT / m), normals(physics.zero, a, b, c, e))


@seldom
def put_gas(thread, counter, bodies, at, drawn):
    """Put particles of the gas on the list of this thread, as one; their moments."""
    n, gas, s = bodies.counters[thread, GAS_COUNT], bodies.gas[thread], drawn.arm
    if n == gas.shape[0]:
        note(bodies.faults[thread], counter.step, TOO_MANY, at.body + 1)
        return no_moments(s)
    m = bodies.gas_mass * drawn.number
    store(gas, n, GAS_PLACE, added(at.centre, s))
    store(gas, n, GAS_VELOCITY, drawn.thermal)
    store(gas, n, GAS_ARM, s)
    gas[n, GAS_SPEED], gas[n, GAS_MASS], gas[n, GAS_INNER] = at.speed, m, drawn.inner
    bodies.gas_number[thread, n] = FIRST_BODY_GAS + drawn.key * MOST_OF_CELL + drawn.draw
    bodies.gas_cell[thread, n] = at.cell
    bodies.gas_body[thread, n] = at.body
    bodies.counters[thread, GAS_COUNT] = n + 1
    arm, p = scaled(1.0 / bodies.lever, s), scaled(m, drawn.thermal)
    return moments_at(m, arm) + p + outer(arm, p)


@scalar
def inner_energy(counter, physics, key, number):
    """The sum of m v^2 of so many particles about their mean velocity."""
    if number == 1 or not needs_energy(physics.energy):
        return 0.0
    freedom = float(len(physics.zero) * (number - 1))
    _, _, a, b = words(counter, BODY_GAS_NUMBER, key, 0)
    inner, sure = likely(a, b, freedom)
    if not sure:
        inner = gamma_number(freedom, counter, BODY_GAS_NUMBER, key)
    return inner * (2.0 * physics.kT)


@scalar
def uniform_place(counter, middle, key, draw):
    """A uniform place in the cell about a middle."""
    a, b, c, _ = words(counter, BODY_GAS_PLACE, key, draw)
    within, r = first((unit_open(a), unit_open(b), unit_open(c)), middle), middle
    for k in range(len(r)):
        r = with_item(r, k, r[k] + within[k] - 0.5)
    return r


@scalar
def take_noise(worker, physics, bodies, i):
    """What is to be taken off the gas of body i, as a velocity and an angular velocity."""
    add_threads(bodies.sums, i)
    total, d = bodies.sums[0, i], len(physics.zero)
    dv, dw = THREE, THREE
    if total[0] != 0:
        work = bodies.work[worker.thread]
        solve_noise(bodies, i, total, d, physics_scales(bodies, physics), work)
        dv, dw = unlevered(bodies, d, work)
    store(bodies.rows, i, CHANGE, dv)
    store(bodies.rows, i, CHANGE + 3, dw)


@seldom
def move_gas(thread, now, physics, fluid, bodies, n):
    """Velocity of a particle of the gas, and what it adds to the sums of its cell."""
    gas, i, zero = bodies.gas[thread], np.int64(bodies.gas_body[thread, n]), physics.zero
    r, s = load(gas, n, GAS_PLACE, zero), load(gas, n, GAS_ARM, zero)
    dv, dw = load(bodies.rows, i, CHANGE, zero), load(bodies.rows, i, CHANGE + 3, THREE)
    noise = added_scaled(load(gas, n, GAS_VELOCITY, zero), -1.0, added(dv, swept(dw, s)))
    normal = s
    if of_kind(bodies, i, B1) != 0.0 or of_kind(bodies, i, B2) != 0.0:
        normal = normal_at(bodies, i, s, 0.0)
    v = added(wall_velocity(bodies, i, s, normal, gas[n, GAS_SPEED]), noise)
    r, v, _ = fold(now.box, r, v, now.grid.shift)
    m, identity = gas[n, GAS_MASS], (bodies.gas_number[thread, n], 0)
    many = Many(np.int64(m / bodies.gas_mass + 0.5), m, gas[n, GAS_INNER])
    found = brought_by_many(physics, now, identity, many, r, v)
    store(gas, n, GAS_PLACE, r)
    store(gas, n, GAS_VELOCITY, v)
    store(gas, n, GAS_KEPT, found.kept)
    sums, cell = fluid.cells.sums[thread], bodies.gas_cell[thread, n]
    place = np.uint64(cell) * np.uint64(sums_length(len(physics.terms)))
    sums[place] += found.tallied
    add_values(sums, place + np.uint64(1), found.terms)


@stage
def take_recoil(worker, now, physics, fluid, bodies):
    """Give bodies what the collision at t + dt gives their gas, in whole numbers."""
    thread, zero = worker.thread, physics.zero
    gas, scale = bodies.gas[thread], momentum_scale(physics)
    count, length = bodies.counters[thread, GAS_COUNT], record_length(len(physics.coefficients))
    for n in range(count):
        ahead = np.int64(bodies.gas_cell[thread, min(n + AHEAD, count - 1)])
        prefetch(fluid.cells.coefficients, ahead * length, 0)
        i, r = np.int64(bodies.gas_body[thread, n]), load(gas, n, GAS_PLACE, zero)
        v, kept = load(gas, n, GAS_VELOCITY, zero), load(gas, n, GAS_KEPT, zero)
        cell = np.uint64(bodies.gas_cell[thread, n])
        record = cell * np.uint64(length)
        needed = load_values(fluid.cells.coefficients, record, physics.coefficients)
        after = collide(physics.rule, needed, kept, in_cell(r, now.grid))
        gain = scaled(gas[n, GAS_MASS], added_scaled(after, -1.0, v))
        units = added_quanta(gain, scale, integers(zero))
        taken = bodies.taken[thread, i]
        add_integers(taken, units)
        p = scaled(1.0 / scale, floats(units))
        arm = load(gas, n, GAS_ARM, zero)
        if now.flags & MEASURE_STRESS:
            add_gas_gain(thread, physics, now, bodies, r, arm, p)
        turn = scaled(1.0 / bodies.lever, outer(arm, p))
        add_integers(taken[len(zero) :], added_quanta(turn, scale, integers(turn)))
    barrier(worker)
    add_others(worker, bodies, bodies.taken, 0)
    low, high = share(len(bodies.rows), thread, worker.threads)
    for body in range(low, high):
        take_impulses(physics, bodies, body)
    if now.flags & MEASURE_STRESS:
        add_body_flux(worker, physics, now, bodies, AFTER)
    barrier(worker)
