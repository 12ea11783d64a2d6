"""The bodies near each cell of the box, the bodies near each body, and the particles near any.

Lists are supersets: which particle hits which body follows from places and velocities alone. So
they save work and change no bit. They hold until a surface has gone farther than `skin`.
"""

import math

import numpy as np

from mesokit.case.box import at_time, fold
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.state import (
    BODY,
    CELL,
    COUNT,
    EVERY_BODY,
    GOING,
    IS_BALL,
    LANE,
    LEFT,
    MEAN_SPIN,
    MEAN_VELOCITY,
    MOST_NEAR_CELL,
    MOST_PARTNERS,
    NO_BODY,
    PATH,
    PLACE,
    RADIUS,
    RANGE,
    START,
    START_V,
    SPARE,
    STEP,
    STRIDE,
    THREE,
    TIME,
    TOO_FAR,
    TOO_MANY,
    TURN,
    WHAT,
    WHICH,
    image_near,
    load,
    of_kind,
    store,
)
from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle
from mesokit.method.mpcd.streaming import halfway, vector
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added_scaled, dot, scaled

HALF_DIAGONAL = 0.5 * math.sqrt(3.0)  # of a cell, in 3D
BEYOND = 1e6  # a path that lists never hold


@scalar
def note(counters, step, what, which):
    """Note the first thing that goes wrong."""
    if counters[STEP] == 0:
        counters[STEP], counters[WHAT], counters[WHICH] = np.int64(step), what, np.int64(which)


@scalar
def box_at_start(now, physics):
    """The box as it is when the flight of this step begins."""
    return at_time(now.box, (now.counter.step - 1) * physics.timestep)


@scalar
def path_of_surface(bodies, i, time):
    """The longest path of any place on a body in a timestep."""
    u, w = load(bodies.rows, i, MEAN_VELOCITY, THREE), load(bodies.rows, i, MEAN_SPIN, THREE)
    return time * (math.sqrt(dot(u, u)) + of_kind(bodies, i, RADIUS) * math.sqrt(dot(w, w)))


@scalar
def keep_lists(worker, now, physics, bodies):
    """Make lists anew if a surface has gone half of the way that they have room for."""
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    farthest = BEYOND if slides(now.box) else 0.0
    for i in range(first, last):
        farthest = max(farthest, bodies.rows[i, PATH])
    bodies.work[worker.thread, 0] = farthest
    barrier(worker)
    for t in range(worker.threads):
        farthest = max(farthest, bodies.work[t, 0])
    barrier(worker)
    if farthest > 0.5 * bodies.skin:
        box = box_at_start(now, physics)
        list_by_cells(worker, box, bodies, physics.zero)
        for i in range(first, last):
            list_partners(bodies, box, i, physics.zero)
        barrier(worker)
        for i in range(first, last):
            bodies.rows[i, PATH] = 0.0


@scalar
def note_path(worker, now, physics, bodies, i):
    """Add the path of the surface of body i in this step to what its lists have room for."""
    path = path_of_surface(bodies, i, physics.timestep)
    if not path <= 0.5 * bodies.skin:
        note(bodies.counters[worker.thread], now.counter.step, TOO_FAR, i + 1)
    bodies.rows[i, PATH] += path
    # Hits may change the motion of this step; images may slide.
    bodies.rows[i, STRIDE] = 2.0 * path + SPARE + slide_of(now.box) * physics.timestep


@by_type
def slide_of(box):
    """The speed at which images slide."""
    if box.instance_class in state.SLIDING:
        return lambda box: abs(box.speed)
    return lambda box: 0.0


@by_type
def slides(box):
    """Whether images of the box slide, so that lists hold for one step only."""
    sliding = box.instance_class in state.SLIDING
    return lambda box: sliding


@seldom
def list_by_cells(worker, box, bodies, zero):
    """The bodies near each cell of this thread's share of the cells."""
    cells = len(bodies.near_count) - 1
    first, last = share(cells, worker.thread, worker.threads)
    for cell in range(first, last):
        bodies.near_count[cell] = 0
    # Body by body, the cells of a cube about it. A thread writes the lists of its own cells only,
    # and bodies come in the order of their numbers.
    for i in range(len(bodies.rows)):
        mark_around(bodies, box, i, (first, last), zero)


@scalar
def mark_around(bodies, box, i, mine, zero):
    """Put body i on the lists of those of my cells that its surface comes near."""
    d, x, radius = len(zero), load(bodies.rows, i, PLACE, zero), of_kind(bodies, i, RADIUS)
    reach = bodies.reach + bodies.skin + HALF_DIAGONAL + (0.5 if slides(box) else 0.0)
    low, high = zero, zero
    for k in range(d):
        low = with_item(low, k, floor(x[k] - radius - reach))
        high = with_item(high, k, floor(x[k] + radius + reach))
    depth = int(high[d - 1] - low[d - 1]) + 1 if d == 3 else 1  # along z
    middle, kind, q = zero, bodies.kind[i], load(bodies.rows, i, TURN, state.FOUR)
    for c in range(depth):
        if d == 3:
            middle = with_item(middle, d - 1, low[d - 1] + c + 0.5)
        for b in range(int(high[1] - low[1]) + 1):
            middle = with_item(middle, 1, low[1] + b + 0.5)
            for a in range(int(high[0] - low[0]) + 1):
                middle = with_item(middle, 0, low[0] + a + 0.5)
                # Under shear an image across an end lies between the cells, so it is in two.
                for half in range(2 if slides(box) else 1):
                    at = with_item(middle, 0, middle[0] + (half - 0.5 if slides(box) else 0.0))
                    here, _, _ = fold(box, at, zero, zero)
                    cell = np.int64(cell_index(here, bodies.grid))
                    if mine[0] <= cell < mine[1] and is_near(bodies, kind, q, x, middle, reach):
                        put_on_list(bodies, cell, i)


@scalar
def is_near(bodies, kind, q, x, place, reach):
    """Whether the surface of a body comes so near to a place; deep inside it does not."""
    away = added_scaled(place, -1.0, x)
    if bodies.kinds[kind, IS_BALL] > 0.5:
        c = math.sqrt(dot(away, away)) - bodies.kinds[kind, RADIUS]
    else:
        c, _ = state.clearance(bodies, kind, state.turned_back(q, away))
    return c <= reach


@scalar
def put_on_list(bodies, cell, i):
    """Add body i to the list of a cell, once."""
    n = bodies.near_count[cell]
    if n == EVERY_BODY or (n > 0 and bodies.near[cell, n - 1] == i):
        return
    if n == MOST_NEAR_CELL:
        bodies.near_count[cell] = EVERY_BODY
    else:
        bodies.near[cell, n] = i
        bodies.near_count[cell] = n + 1


@seldom
def list_partners(bodies, box, i, zero):
    """The other bodies that may come within the range of the potential of gaps."""
    x, found = load(bodies.rows, i, PLACE, zero), 0
    for j in range(len(bodies.rows)):
        if j != i:
            reach = of_kind(bodies, i, RADIUS) + of_kind(bodies, j, RADIUS) + 2.0 * bodies.skin
            reach += max(of_kind(bodies, i, RANGE), of_kind(bodies, j, RANGE))
            other, _ = image_near(box, load(bodies.rows, j, PLACE, zero), x)
            away = added_scaled(other, -1.0, x)
            if dot(away, away) <= reach * reach:
                if found < MOST_PARTNERS:
                    bodies.partners[i, found] = j
                found += 1
    bodies.partner_count[i] = found if found <= MOST_PARTNERS else EVERY_BODY


# --- particles ------------------------------------------------------------------------------------


@scalar
def path_of(bodies, physics, r, v):
    """The longest path that a particle can fly in a timestep."""
    a, time = vector(halfway(physics.field, r, v, physics.timestep), r), physics.timestep
    path = time * math.sqrt(dot(v, v)) + 0.5 * time * time * math.sqrt(dot(a, a))
    return path + bodies.further


@scalar
def choose_near(worker, now, physics, bodies, strip, s, count, marks):
    """Put the particles of strip s that may meet a body on the list of this thread.

    Their lanes become the first entries of `marks`; returns their number.
    """
    zero, thread, candidates, chosen = physics.zero, worker.thread, 0, 0
    d, box = len(zero), box_at_start(now, physics)
    # Coarse test of all lanes at t, before the flight, by the lists of cells. No branches.
    for i in range(count):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        listed = bodies.near_count[cell_of(bodies, box, r)] != 0
        marks[i] = np.int64(listed | (not path_of(bodies, physics, r, v) <= bodies.travel))
    # Compact the lanes of candidates to the front, again without branches.
    for i in range(count):
        mark = marks[i]
        marks[candidates] = i
        candidates += mark
    # Exact test of the few candidates, by the distances from the bodies on their lists.
    for j in range(candidates):
        i = marks[j]
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        path = path_of(bodies, physics, r, v)
        cell = np.int64(cell_of(bodies, box, r))
        if not path <= bodies.travel or bodies.near_count[cell] == EVERY_BODY:
            cell = np.int64(EVERY_BODY)
        if may_meet(bodies, box, cell, r, path):
            n = bodies.counters[thread, COUNT]
            if n == bodies.values.shape[1]:
                note(bodies.counters[thread], now.counter.step, TOO_MANY, 0)
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


@by_type
def cell_of(bodies, box, r):
    """The cell of the lists at a place; under shear that of its image in the box."""
    if box.instance_class in state.SLIDING:

        def folded(bodies, box, r):
            here, _, _ = fold(box, r, r, scaled(0.0, r))
            return cell_index(here, bodies.grid)

        return folded
    return lambda bodies, box, r: cell_index(r, bodies.grid)


@scalar
def bodies_near(bodies, cell):
    """How many bodies are on the list of a cell, or all where a list does not hold."""
    return len(bodies.rows) if cell == EVERY_BODY else bodies.near_count[cell]


@scalar
def body_near(bodies, cell, n):
    """The nth of them."""
    return np.int64(n) if cell == EVERY_BODY else np.int64(bodies.near[cell, n])


@seldom
def may_meet(bodies, box, cell, r, path):
    """Whether a particle at r that flies so far may meet a body on the list of its cell."""
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
        away = added_scaled(r, -1.0, x)
        stride = path + bodies.rows[i, STRIDE]
        bound = of_kind(bodies, i, RADIUS) + stride
        square = dot(away, away)
        if not square > bound * bound:
            if of_kind(bodies, i, IS_BALL) > 0.5:
                return True
            q = load(bodies.rows, i, TURN, state.FOUR)
            c, _ = state.clearance(bodies, bodies.kind[i], state.turned_back(q, away))
            if not c > stride:
                return True
    return False
