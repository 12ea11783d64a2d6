"""One pass over a fluid with bodies: particles that may meet a body wait for it to move.

Without bodies this costs nothing: it is another pass (see `cpu.sweep`).
"""

import math

import numpy as np

from mesokit.case.box import SLIDING
from mesokit.geometry.solids.bodies import Bodies
from mesokit.kernels.part import stage
from mesokit.loops.layout import LANES, LAST_LANE, SCRATCH_ROW, lanes_in, share, strip_at, strips_in
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.near import (
    ALLOWANCE,
    BEYOND,
    PARTS,
    SEVERAL,
    bodies_near,
    body_near,
    box_at_start,
    cell_of,
    cube_of,
    list_of,
    takes_counter,
)
from mesokit.method.mpcd.engine.bodies.state import (
    BODY,
    CELL,
    COUNT,
    GOING,
    IMAGE,
    IS_BALL,
    LANE,
    LEFT,
    MEAN_VELOCITY,
    NO_BODY,
    PLACE,
    PUT_BACK,
    RADIUS,
    SECOND_HITS,
    START,
    START_V,
    STILL_HITTING,
    STRIDE,
    TIME,
    TURN,
    R,
    V,
    image_near,
    load,
    of_kind,
    store,
)
from mesokit.method.mpcd.engine.bodies.stress import take_near_flux
from mesokit.method.mpcd.engine.cpu import stages
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.near_solids import FEW, forget, look_around_strip
from mesokit.method.mpcd.engine.cpu.physics import field_of, of_bodies
from mesokit.method.mpcd.engine.cpu.strips.ahead import strip_after
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import tally
from mesokit.method.mpcd.engine.cpu.strips.one import put_one
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle, load_scratch, store_scratch
from mesokit.method.mpcd.engine.cpu.sweep import add_strip_flux
from mesokit.method.mpcd.engine.domains.messages.ghosts import note_ghosts
from mesokit.method.mpcd.engine.domains.messages.migrate import note_migrants
from mesokit.method.mpcd.engine.domains.messages.shared import shares
from mesokit.method.mpcd.engine.embedded.near import note
from mesokit.method.mpcd.engine.embedded.state import TOO_MANY
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.field.none import Zero
from mesokit.method.mpcd.streaming import halfway, vector
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.prefetch import prefetch
from mesokit.scalar.vector import added_scaled, dot, scaled

KEEP, RESTORE = 0, 1
# Rows of the flights of candidates: their places, velocities and paths, and the ball near each.
PLACE_OF, VELOCITY_OF, BALL_OF, BALL_VELOCITY_OF, RADIUS_OF, PATH_OF = 0, 3, 6, 9, 12, 13
PASSES, MEETS, UNKNOWN = 0.0, 1.0, 2.0  # what is seen of a candidate and the ball near it
WAITING = -1  # the cell of a particle that has not flown yet


@where(box=lambda box: box.instance_class in SLIDING)
def keep_images(box, bodies, thread, near, chosen, image, what):
    """Keep the image counts of the particles near bodies, which are counted when they are put back,
    or restore them."""
    for j in range(near):
        n = bodies.counters[thread, COUNT] - near + j
        for k in range(len(image)):
            if what == KEEP:
                bodies.numbers[thread, n, IMAGE + k] = image[k, chosen[j]]
            else:
                image[k, chosen[j]] = np.int32(bodies.numbers[thread, n, IMAGE + k])


@stage
def stream_around_bodies(worker, now, physics, fluid, bodies):
    """Do the stages that the flags have (see `cpu.sweep`) for particles that no body can reach.

    Of the others velocities are those after the collision; they are on the list of this thread.
    """
    particles, scratch, zero = fluid.particles, fluid.scratch, physics.zero
    gathered, terms = scratch.coefficients[worker.thread], scratch.terms[worker.thread]
    clear, marks = scratch.clear[worker.thread], scratch.marks[worker.thread]
    chosen, impulse = bodies.chosen[worker.thread], fluid.taken.impulse[worker.thread]
    stride = stride_of(physics.solid)
    sums, here = fluid.cells.sums[worker.thread], bodies.counters[worker.thread]
    tensor, measured = fluid.taken.tensor, now.flags & MEASURE_STRESS
    if now.flags & STREAM:
        here[COUNT] = here[PUT_BACK] = here[SECOND_HITS] = here[STILL_HITTING] = 0
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    # As `cpu.sweep`, but particles near a body are copied to a list with r and v at t, after the
    # collision. Their lanes fly with the others, for whole vectors, and do not count: their terms
    # go to the spare cell. `put_all_back` restores them at t + dt.
    for s in range(first, last):
        lanes, places = lanes_in(particles.filling, s), slice(s * LANES, (s + 1) * LANES)
        strip, cell = particles.data[strip_at(s, particles.rows)], particles.cell[places]
        ids, image = particles.ident[places], particles.image[:, places]
        following = strip_after(fluid, physics, s, last)
        if now.flags & COLLIDE:
            coefficients = fluid.cells.coefficients
            stages.gather_strip(cell, coefficients, gathered, physics.coefficients, following)
            stages.collide_strip(physics, now.old, strip, gathered)
            if measured and not now.flags & STREAM:
                add_strip_flux(physics, now.box, now.old, strip, lanes, tensor[1, s])
        if now.flags & STREAM:
            plain = of_bodies(physics)
            quiet = look_around_strip(physics.solid, strip, s, fluid.room, clear, zero)
            straight = quiet, stride
            near = choose_near_bodies(worker, now, plain, bodies, strip, s, lanes, straight)
            left = stages.stream_strip(physics, strip, clear, marks)
            if left != 0:
                for j in range(near):  # they meet walls later
                    marks[chosen[j]] = 0
                far = stages.bounce_strip(
                    physics, now.counter, strip, lanes, left, ids, marks, impulse
                )
                forget(fluid.room, s, far)
            keep_images(now.box, bodies, worker.thread, near, chosen, image, KEEP)
            stages.slide_strip(now.box, now.grid, strip, image, zero)
            keep_images(now.box, bodies, worker.thread, near, chosen, image, RESTORE)
            if measured:
                add_strip_flux(physics, now.box, now.grid, strip, lanes, tensor[0, s])
                take_near_flux(physics, now, strip, chosen, near, tensor[0, s])
            stages.bin_strip(physics, now, strip, cell, ids, terms)
            for j in range(near):
                cell[chosen[j]] = fluid.cells.number  # which takes what must not act
            tallied = tally(physics.energy, 0.0, zero)
            stages.add_strip(cell, terms, sums, lanes, physics.terms, tallied, following)
            for j in range(near):
                cell[chosen[j]] = WAITING
            note_ghosts(worker, s, fluid, cell, terms, lanes, physics.terms, tallied)


@by_type
def stride_of(solid):
    """The path on which solids bend no flight of a quiet part of a strip (see `near_solids`)."""
    return (lambda solid: solid.stride) if solid.instance_class is Bodies else (lambda solid: 0.0)


@by_type
def longest_flight(bodies, physics, r, v, clear):
    """The longest path that a particle can fly in a timestep; no wall is on one that is clear."""
    if field_of(physics, "field").instance_class is Zero:

        def straight(bodies, physics, r, v, clear):
            path = physics.timestep * math.sqrt(dot(v, v))
            return path if path < clear else path + bodies.further

        return straight

    def bent(bodies, physics, r, v, clear):
        a, time = vector(halfway(physics.field, r, v, physics.timestep), r), physics.timestep
        path = time * math.sqrt(dot(v, v)) + 0.5 * time * time * math.sqrt(dot(a, a))
        return path if path < clear else path + bodies.further

    return bent


@by_type
def may_reach(bodies, physics, r, v, distance):
    """Whether a particle can fly so far in a timestep."""
    if field_of(physics, "field").instance_class is Zero:  # without a root

        def straight(bodies, physics, r, v, distance):
            left, time = max(distance - bodies.further, 0.0), physics.timestep
            return not time * time * dot(v, v) < left * left

        return straight
    return lambda bodies, physics, r, v, distance: (
        not longest_flight(bodies, physics, r, v, 0.0) < distance
    )


@scalar
def choose_near_bodies(worker, now, physics, bodies, strip, s, count, straight):
    """Put the particles of strip s that may meet a body on the list of this thread.

    Their lanes become the first entries of `bodies.chosen`; returns their number. `straight`: the
    parts in which no wall bends shorter flights than a stride, as bits, and this stride.
    """
    zero, thread, candidates, chosen = physics.zero, worker.thread, 0, 0
    marks, (quiet, stride) = bodies.chosen[thread], straight
    time, d, box, allowance = (
        physics.timestep,
        len(zero),
        box_at_start(now, physics),
        bodies.work[thread, ALLOWANCE],
    )
    cubes, any_near = bodies.cubes[thread], np.int32(0)
    # Coarse test of all lanes at t, before the flight, by what is clear around cubes. Three loops,
    # of which the first and the last become vectors: between them is the gather from the table.
    for i in range(LANES):
        cubes[i] = cube_of(bodies, box, load_particle(strip, i, 0, zero))
    for i in range(LANES):
        cubes[i] = np.int32(bodies.clear[np.uint32(cubes[i])])
    for i in range(LANES):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        clear = float(cubes[i]) * (1.0 / PARTS) - allowance
        cubes[i] = np.int32(may_reach(bodies, physics, r, v, clear))
        any_near |= cubes[i]
    # Compact the lanes of candidates to the front, again without branches.
    for i in range(count if any_near != 0 else 0):
        marks[i] = np.int64(cubes[i])
    for i in range(count if any_near != 0 else 0):
        mark = marks[i]
        marks[candidates & LAST_LANE] = i
        candidates += mark
    # Most candidates are near one ball alone, and fly past it. That is seen in loops over vectors,
    # with one between them that looks up the ball.
    flights = bodies.columns[thread]
    for j in range(candidates):
        i = marks[j] & LAST_LANE
        store_scratch(flights, PLACE_OF * SCRATCH_ROW + j, load_particle(strip, i, 0, zero))
        store_scratch(flights, VELOCITY_OF * SCRATCH_ROW + j, load_particle(strip, i, d, zero))
    for j in range(candidates):
        r, v = (
            load_scratch(flights, PLACE_OF * SCRATCH_ROW + j, zero),
            load_scratch(flights, VELOCITY_OF * SCRATCH_ROW + j, zero),
        )
        clear = stride if (quiet >> (marks[j] // FEW)) & 1 != 0 else 0.0
        flights[PATH_OF * SCRATCH_ROW + j] = longest_flight(bodies, physics, r, v, clear)
        cubes[j] = np.int32(cell_of(bodies, box, r))
    for j in range(candidates):
        prefetch(bodies.alone, cubes[j], 0)
    for j in range(candidates):
        look_up_ball(bodies, box, flights, np.int64(cubes[j]), allowance, j, zero)
    for j in range(candidates):
        flights[RADIUS_OF * SCRATCH_ROW + j] = passes_ball(box, flights, j, time, zero)
    # Exact test of the few others, by the bodies on their lists.
    for j in range(candidates):
        if flights[RADIUS_OF * SCRATCH_ROW + j] == PASSES:
            continue
        i, reach = marks[j], flights[PATH_OF * SCRATCH_ROW + j] + allowance
        cell = list_of(bodies, np.int64(cubes[j]), reach)
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        path = flights[PATH_OF * SCRATCH_ROW + j]
        if (
            flights[RADIUS_OF * SCRATCH_ROW + j] == MEETS
            or may_hit(bodies, physics, box, cell, r, v, path)
            or takes_counter(bodies, box, cell, r)
        ):
            n = bodies.counters[thread, COUNT]
            if n == bodies.values.shape[1]:
                note(bodies.faults[thread], now.counter.step, TOO_MANY, 0)
                break
            store(bodies.values[thread], n, START, r)
            store(bodies.values[thread], n, START_V, v)
            bodies.values[thread, n, TIME] = 0.0
            bodies.numbers[thread, n, LANE] = s * len(marks) + i
            bodies.numbers[thread, n, CELL] = cell
            bodies.numbers[thread, n, BODY] = NO_BODY
            bodies.numbers[thread, n, LEFT] = NO_BODY
            bodies.numbers[thread, n, GOING] = 1
            bodies.counters[thread, COUNT] = n + 1
            marks[chosen] = i
            chosen += 1
    return chosen


@seldom
def may_hit(bodies, physics, box, cell, r, v, path):
    """Whether a particle at r, which flies so far, may meet a body on the list of its cell.

    It follows from places and velocities alone. A ball that is larger by what its motion may still
    change must lie on the straight flight of a particle that no force and no wall bends.
    """
    time = physics.timestep
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        x, speed = image_near(box, load(bodies.rows, i, PLACE, r), r)
        away, stride, kind = added_scaled(r, -1.0, x), bodies.rows[i, STRIDE], bodies.kind[i]
        if bodies.kinds[kind, IS_BALL] > 0.5:
            u = load(bodies.rows, i, MEAN_VELOCITY, r)
            radius, w = flight_by_ball(of_kind(bodies, i, RADIUS) + stride, u, v, speed, path, time)
            if meets_ball(radius, away, w, time):
                return True
        else:
            q = load(bodies.rows, i, TURN, state.FOUR)
            if state.is_nearer(bodies, kind, q, away, path + stride):
                y, flown = state.rotated_back(q, away), state.rotated_back(q, scaled(time, v))
                _, lowest = state.heights_on_flight(bodies, kind, y, flown)
                if lowest <= stride or not is_straight(path, v, time):
                    return True
    return False


@scalar
def is_straight(path, v, time):
    """Whether no force and no wall can bend a flight whose longest path is given."""
    return path * path <= time * time * dot(v, v) * (1.0 + 1e-12)


@scalar
def flight_by_ball(radius, u, v, speed, path, time):
    """Radius of a ball that a flight must enter to hit a body, and the velocity of the flight
    relative to that of the ball, u in an image with a speed.

    A flight that is bent may go anywhere on its path: it starts in a larger ball, or meets none.
    """
    part = 1.0 if is_straight(path, v, time) else 0.0
    w = added_scaled(v, -1.0, state.with_shear(u, speed))
    return radius + (1.0 - part) * path, scaled(part, w)


@scalar
def meets_ball(radius, y, w, time):
    """Whether a straight flight from y enters a ball about 0 within a time, or starts in it."""
    approach, square = dot(y, w), dot(w, w)
    # The distance is least at the time -approach/square, or at an end of the flight.
    end = min(max(-approach / max(square, 1e-300), 0.0), time)
    return dot(y, y) - radius * radius + end * (2.0 * approach + end * square) <= 0.0


@scalar
def look_up_ball(bodies, box, flights, cell, allowance, j, zero):
    """Put the ball that is alone near a candidate, on the list of its cell, in its column.

    Where none is, or the particle takes a counter-force, it is one of radius BEYOND.
    """
    x, u, radius, r = zero, zero, BEYOND, load_scratch(flights, PLACE_OF * SCRATCH_ROW + j, zero)
    holds = flights[PATH_OF * SCRATCH_ROW + j] + allowance < bodies.list_reach
    i = np.int64(bodies.alone[cell]) if holds else np.int64(SEVERAL)
    ball = i >= 0 and of_kind(bodies, i, IS_BALL) > 0.5
    if ball and not takes_counter(bodies, box, cell, r):
        x, u = load(bodies.rows, i, PLACE, zero), load(bodies.rows, i, MEAN_VELOCITY, zero)
        radius = of_kind(bodies, i, RADIUS) + bodies.rows[i, STRIDE]
    store_scratch(flights, BALL_OF * SCRATCH_ROW + j, x)
    store_scratch(flights, BALL_VELOCITY_OF * SCRATCH_ROW + j, u)
    flights[RADIUS_OF * SCRATCH_ROW + j] = radius


@scalar
def passes_ball(box, flights, j, time, zero):
    """Whether a candidate may meet the ball in its column."""
    r, v = (
        load_scratch(flights, PLACE_OF * SCRATCH_ROW + j, zero),
        load_scratch(flights, VELOCITY_OF * SCRATCH_ROW + j, zero),
    )
    x, speed = image_near(box, load_scratch(flights, BALL_OF * SCRATCH_ROW + j, zero), r)
    u, path = (
        load_scratch(flights, BALL_VELOCITY_OF * SCRATCH_ROW + j, zero),
        flights[PATH_OF * SCRATCH_ROW + j],
    )
    ball = flights[RADIUS_OF * SCRATCH_ROW + j]
    radius, w = flight_by_ball(ball, u, v, speed, path, time)
    meets = MEETS if meets_ball(radius, added_scaled(r, -1.0, x), w, time) else PASSES
    return UNKNOWN if ball == BEYOND else meets


@scalar
def put_all_back(worker, now, physics, fluid, bodies):
    """All particles of this thread's list at t + dt, with the terms for their new cells."""
    if not now.flags & STREAM:
        return
    thread, values, zero = worker.thread, bodies.values[worker.thread], physics.zero
    for j in range(bodies.counters[thread, COUNT]):
        r, v = load(values, j, R, zero), load(values, j, V, zero)
        start = load(values, j, START, zero)
        put_one(worker, now, physics, fluid, bodies.numbers[thread, j, LANE], start, r, v)
    note_all_migrants(worker, now, physics, fluid)
    barrier(worker)


@where(fluid=shares)
def note_all_migrants(worker, now, physics, fluid):
    """Note the particles that must change ranks in this step, when all have flown."""
    particles = fluid.particles
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    for s in range(first, last):
        strip = particles.data[strip_at(s, particles.rows)]
        note_migrants(worker, now, physics, fluid, strip, s)
