"""The bodies near each cell of the box, and the bodies near each body.

Lists are supersets: which particle hits which body follows from places and velocities alone. So
they save work and change no bit. They hold until a surface has gone farther than `skin`.
"""

import math

import numpy as np

from mesokit.case.box import at_time, fold
from mesokit.geometry import primitive
from mesokit.geometry.primitive import WIDTH
from mesokit.loops.layout import share
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.bodies import state
from mesokit.method.mpcd.engine.bodies.state import (
    EVERY_BODY,
    FIRST_PART,
    MEAN_SPIN,
    MEAN_VELOCITY,
    MOST_NEAR_CELL,
    MOST_PARTNERS,
    NO_BODY,
    PARTS_END,
    PATH,
    PLACE,
    RADIUS,
    RANGE,
    SPARE,
    STRIDE,
    THREE,
    TURN,
    distance_of,
    image_near,
    is_nearer,
    load,
    of_kind,
)
from mesokit.method.mpcd.engine.cpu.grid import cell_index
from mesokit.method.mpcd.engine.cpu.physics import field_of
from mesokit.method.mpcd.engine.embedded.near import note
from mesokit.method.mpcd.engine.embedded.state import STEP
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import by_type, scalar, seldom
from mesokit.scalar.vector import added_scaled, dot, scaled

HALF_DIAGONAL = 0.5 * math.sqrt(3.0)  # of a cell, in 3D
BEYOND = 1e6  # a path that lists never hold
LONGEST_REACH = 2.0  # cells: the farthest that lists reach (see `MovingBodies.list_reach`)
LISTS_HOLD = 0.25  # cells: lists are made anew when a surface has gone so far
PARTNERS_HOLD = 0.6  # cells: the farthest that surfaces may go with one list of partners
PARTS = 64.0  # of a cell: what is clear is kept in whole numbers of these
# Where scratch memory has how far surfaces go with one list, and how far images have slid.
FARTHEST, ALLOWANCE, SLID = 250, 251, 252
SEVERAL, NO_BODIES = -2, -2  # in the table of single bodies; as a list (see `list_of`)


def kicks_fluid(bodies):
    """Whether the fluid near bodies takes counter-forces, from the numba type of `MovingBodies`."""
    return len(field_of(bodies, "counters_near")) > 0


@scalar
def box_at_start(now, physics):
    """The box as it is when the flight of this step begins."""
    return at_time(now.box, (now.counter.step - 1) * physics.timestep)


@scalar
def path_of_surface(bodies, i, time):
    """The longest way that the surface of a body goes in a timestep; a ball that turns stays."""
    u, w = load(bodies.rows, i, MEAN_VELOCITY, THREE), load(bodies.rows, i, MEAN_SPIN, THREE)
    return time * (math.sqrt(dot(u, u)) + of_kind(bodies, i, state.SWEPT) * math.sqrt(dot(w, w)))


@scalar
def keep_lists(worker, now, physics, bodies):
    """Make lists anew if a surface has gone far since they were made, or images have slid far."""
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    farthest, slid = 0.0, bodies.work[worker.thread, SLID]
    for i in range(first, last):
        farthest = max(farthest, bodies.rows[i, PATH])
    if farthest_of_all(worker, bodies, farthest) + slid > LISTS_HOLD:
        box = box_at_start(now, physics)
        list_by_cells(worker, box, bodies, physics.zero)
        for i in range(first, last):
            list_other_bodies(bodies, box, i, physics.zero)
        barrier(worker)
        for i in range(first, last):
            bodies.rows[i, PATH] = 0.0
        bodies.work[worker.thread, SLID] = 0.0


@scalar
def farthest_of_all(worker, bodies, farthest):
    """The largest of a number of each thread."""
    bodies.work[worker.thread, FARTHEST] = farthest
    barrier(worker)
    for t in range(worker.threads):
        farthest = max(farthest, bodies.work[t, FARTHEST])
    barrier(worker)
    return farthest


@scalar
def note_paths(worker, now, physics, bodies):
    """How far surfaces go in this step, and at most have gone since lists were made."""
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    farthest = 0.0
    for i in range(first, last):
        path = path_of_surface(bodies, i, physics.timestep)
        # Hits may change the motion of this step; images may slide.
        bodies.rows[i, STRIDE] = 2.0 * path + SPARE + slide_of(now.box) * physics.timestep
        farthest = max(farthest, bodies.rows[i, PATH] + bodies.rows[i, STRIDE])
        bodies.rows[i, PATH] += path
        if bodies.rows[i, PATH] > PARTNERS_HOLD and of_kind(bodies, i, state.DEPTH) > 0.0:
            note_fast(bodies.faults[worker.thread], now.counter.step, i, path / physics.timestep)
    farthest = farthest_of_all(worker, bodies, farthest)
    bodies.work[worker.thread, ALLOWANCE] = farthest + bodies.work[worker.thread, SLID]
    bodies.work[worker.thread, SLID] += slide_of(now.box) * physics.timestep


@seldom
def note_fast(faults, step, i, speed):
    """Note a body that goes farther than the list of its partners holds: it may miss a gap."""
    if faults[STEP] == 0:
        faults[state.SPEED] = np.int64(min(speed, 1e9) / state.MILLIONTH)
    note(faults, step, state.TOO_FAST, i + 1)


@seldom
def lengthen_path(bodies, i, now, time):
    """Add what hits have added to the path of body i in this step."""
    planned = 0.5 * (bodies.rows[i, STRIDE] - SPARE - slide_of(now.box) * time)
    bodies.rows[i, PATH] += max(path_of_surface(bodies, i, time) - planned, 0.0)


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
    """The bodies near each cell of this thread's share of the cells, and what is clear there."""
    cells, d, far = len(bodies.near_count) - 1, len(zero), parts_clear(bodies, bodies.list_reach)
    first, last = share(cells, worker.thread, worker.threads)
    for cell in range(first, last):
        bodies.near_count[cell], bodies.alone[cell] = 0, NO_BODY
        for cube in range(1 << d):
            bodies.clear[half_of(bodies, cell, cube, d)] = far
    # Body by body, the cells of a cube about it. A thread writes the lists of its own cells only,
    # and bodies come in the order of their numbers.
    for i in range(len(bodies.rows)):
        list_around(bodies, box, i, (first, last), zero)


@scalar
def list_around(bodies, box, i, mine, zero):
    """Put body i on the lists of those of my cells that its surface comes near."""
    d, x, radius = len(zero), load(bodies.rows, i, PLACE, zero), of_kind(bodies, i, state.REACH)
    reach = bodies.list_reach + HALF_DIAGONAL + (0.5 if slides(box) else 0.0)
    low, high = zero, zero
    for k in range(d):
        low = with_item(low, k, floor(x[k] - radius - bodies.list_reach))
        high = with_item(high, k, floor(x[k] + radius + bodies.list_reach))
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
                    if mine[0] <= cell < mine[1]:
                        away = added_scaled(middle, -1.0, x)
                        if is_listed(bodies, kind, q, away, reach):
                            put_on_list(bodies, cell, i)
                            clear_cubes(bodies, box, kind, q, cell, away)


@where("is_nearer(bodies, kind, q, s, reach)", bodies=kicks_fluid)
def is_listed(bodies, kind, q, s, reach):
    """Whether a place at an arm is nearer than a reach to the surface of a body, or to the ball or
    the shell in which the fluid takes its counter-forces."""
    radius = bodies.kinds[kind, state.BALL_RADIUS]
    near_ball = radius > 0.0 and distance_to_ball(bodies, kind, q, s) - radius < reach
    return near_ball or is_nearer(bodies, kind, q, s, reach + bodies.kinds[kind, state.SHELL])


@seldom
def distance_to_ball(bodies, kind, q, s):
    """Distance of a place at an arm from the middle of the ball of a kind."""
    away = added_scaled(s, -1.0, state.rotated(q, load(bodies.kinds, kind, state.BALL_AT, s)))
    return math.sqrt(dot(away, away))


@seldom
def is_in_ball(bodies, i, s):
    """Whether a place at an arm from body i is where the fluid takes its counter-force."""
    radius, q = of_kind(bodies, i, state.BALL_RADIUS), load(bodies.rows, i, TURN, state.FOUR)
    return radius > 0.0 and distance_to_ball(bodies, bodies.kind[i], q, s) < radius


@seldom
def is_in_shell(bodies, i, s):
    """Whether a place at an arm from body i is where the fluid takes its counter-torque."""
    thick, q = of_kind(bodies, i, state.SHELL), load(bodies.rows, i, TURN, state.FOUR)
    return thick > 0.0 and distance_of(bodies, bodies.kind[i], q, s) < thick


@where("False", bodies=kicks_fluid)
def takes_counter(bodies, box, cell, r):
    """Whether the particle at r takes a counter-force or counter-torque of a body near its cell."""
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
        s = added_scaled(r, -1.0, x)
        if is_in_ball(bodies, i, s) or is_in_shell(bodies, i, s):
            return True
    return False


@seldom
def clear_cubes(bodies, box, kind, q, cell, s):
    """Lower what is clear around the halves of a cell whose middle is at an arm."""
    y = state.rotated_back(q, s)
    for part in range(int(bodies.kinds[kind, FIRST_PART]), int(bodies.kinds[kind, PARTS_END])):
        p = bodies.parts + 8 * WIDTH * part
        c, normal = primitive.facing(bodies.part_code[part], p, bodies.parts, y)
        c -= bodies.kinds[kind, state.SHELL]
        clear_halves(bodies, box, cell, c, state.rotated(q, normal))
    clear_around_ball(bodies, box, kind, q, cell, s)


@where(bodies=kicks_fluid)
def clear_around_ball(bodies, box, kind, q, cell, s):
    """The same for the ball in which the fluid takes a counter-force."""
    radius = bodies.kinds[kind, state.BALL_RADIUS]
    if radius > 0.0:
        away = added_scaled(s, -1.0, state.rotated(q, load(bodies.kinds, kind, state.BALL_AT, s)))
        far = math.sqrt(dot(away, away))
        clear_halves(bodies, box, cell, far - radius, scaled(1.0 / max(far, 1e-9), away))


@scalar
def clear_halves(bodies, box, cell, distance, normal):
    """The same for a convex solid, by its distance from the middle of the cell, and its normal.

    A half lies no nearer to the solid than to the plane that touches it.
    """
    d = len(normal)
    for cube in range(1 << d):
        rise = 0.0
        for k in range(d):
            rise += normal[k] * (0.25 if (cube >> k) & 1 else -0.25)
        c = distance + rise - 0.5 * HALF_DIAGONAL - (0.5 if slides(box) else 0.0)
        place = half_of(bodies, cell, cube, d)
        clear = parts_clear(bodies, c) if distance > 0.0 else np.uint8(0)
        bodies.clear[place] = min(bodies.clear[place], clear)


@scalar
def parts_clear(bodies, distance):
    """What is clear, in whole parts of a cell, as far as lists reach."""
    return np.uint8(int(min(max(distance, 0.0), bodies.list_reach) * PARTS))


@scalar
def half_of(bodies, cell, cube, d):
    """Number, among the cubes of half a cell, of one of those of a cell."""
    place, stride, rest = 0, 1, cell
    for k in range(d):
        cells = int(bodies.grid.cells[k])
        place += (2 * (rest % cells) + ((cube >> k) & 1)) * stride
        rest //= cells
        stride *= 2 * cells
    return place


@seldom
def put_on_list(bodies, cell, i):
    """Add body i to the list of a cell, once."""
    n = bodies.near_count[cell]
    if n == EVERY_BODY or (n > 0 and bodies.near[cell, n - 1] == i):
        return
    bodies.alone[cell] = i if n == 0 else SEVERAL
    if n == MOST_NEAR_CELL:
        bodies.near_count[cell] = EVERY_BODY
    else:
        bodies.near[cell, n] = i
        bodies.near_count[cell] = n + 1


@seldom
def list_other_bodies(bodies, box, i, zero):
    """The other bodies that may come within the range of the potential of gaps."""
    x, found = load(bodies.rows, i, PLACE, zero), 0
    for j in range(len(bodies.rows)):
        if j != i:
            reach = of_kind(bodies, i, RADIUS) + of_kind(bodies, j, RADIUS) + 2.0 * PARTNERS_HOLD
            reach += max(of_kind(bodies, i, RANGE), of_kind(bodies, j, RANGE))
            other, _ = image_near(box, load(bodies.rows, j, PLACE, zero), x)
            away = added_scaled(other, -1.0, x)
            if dot(away, away) <= reach * reach:
                if found < MOST_PARTNERS:
                    bodies.partners[i, found] = j
                found += 1
    bodies.partner_count[i] = found if found <= MOST_PARTNERS else EVERY_BODY


# --- the list of a place --------------------------------------------------------------------------


@by_type
def in_lists(box, r):
    """The image of a place whose cell has a list: under shear that in the box."""
    if box.instance_class in state.SLIDING:

        def folded(box, r):
            here, _, _ = fold(box, r, r, scaled(0.0, r))
            return here

        return folded
    return lambda box, r: r


@scalar
def cell_of(bodies, box, r):
    """The cell of the lists at a place."""
    return cell_index(in_lists(box, r), bodies.grid)


@scalar
def cube_of(bodies, box, r):
    """The half of a cell in each direction, of which it is known what is clear: cells of half the
    size, numbered as those of the lists are."""
    return cell_index(scaled(2.0, in_lists(box, r)), bodies.halves)


@scalar
def list_of(bodies, cell, reach):
    """The list that has all bodies within reach of a place in a cell.

    It is the number of the cell, EVERY_BODY, NO_BODIES, or NO_BODIES - 1 - i of body i alone: of
    the last two no list is fetched.
    """
    one = np.int64(bodies.alone[cell])
    if reach >= bodies.list_reach or (one == SEVERAL and bodies.near_count[cell] == EVERY_BODY):
        return np.int64(EVERY_BODY)
    return np.int64(cell) if one == SEVERAL else NO_BODIES + NO_BODY - one


@scalar
def bodies_near(bodies, listed):
    """How many bodies are on a list."""
    if listed >= 0:
        return np.int64(bodies.near_count[listed])
    return len(bodies.rows) if listed == EVERY_BODY else np.int64(listed < NO_BODIES)


@scalar
def body_near(bodies, listed, n):
    """The nth of them."""
    if listed >= 0:
        return np.int64(bodies.near[listed, n])
    return np.int64(n) if listed == EVERY_BODY else NO_BODIES + NO_BODY - listed


@scalar
def farthest_gap(bodies):
    """The largest gap at which any body repels."""
    farthest = 0.0
    for kind in range(len(bodies.kinds)):
        farthest = max(farthest, bodies.kinds[kind, RANGE])
    return farthest
