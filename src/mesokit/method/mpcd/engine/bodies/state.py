"""Bodies in memory: a row of numbers for each body, and one for each kind of bodies."""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.case.box import SLIDING
from mesokit.geometry import primitive
from mesokit.geometry.primitive import WIDTH
from mesokit.scalar.elementary import rint, sincos_turn
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import by_type, elementwise, scalar, seldom
from mesokit.scalar.vector import added, added_scaled, dot

# Columns of the row of a body. Vectors have three places; in 2D angular velocities are along z.
# PLACE and TURN, a unit quaternion w, x, y, z, are those of the beginning of a timestep until all
# flights have ended; velocities are already those after it.
PLACE, TURN, VELOCITY, SPIN = 0, 3, 7, 10
MEAN_VELOCITY, MEAN_SPIN = 13, 16  # of its rigid motion in this timestep
CHANGE = 19  # of velocity (3) and angular velocity (3) by the reflection in hand
BOXES, ANGLE = 25, 28  # boxes that it is away; its angular velocity, summed over time
FORCE, TORQUE = 31, 34  # impulse of the last timestep over its length
HOME = 37  # where a trap holds it
PATH, STRIDE = 40, 41  # how far its surface went since lists were made, and may go in this step
END_TURN, BEGIN, BEGIN_TURN = 42, 46, 49  # orientation after this timestep; both before it
KICK = 53  # impulse on a particle in its ball; w (3) and c (3) of the gain w x s + c in its shell
COLUMNS = 62

# Columns of the row of a kind. Symmetric matrices are xx, yy, zz, xy, xz, yz in the body's frame.
MASS, INVERSE, ROOT = 0, 1, 4  # 1/mass and its root, for each axis: 0 where it is fixed
RADIUS, IS_BALL, IS_SLIP, FILLED = 7, 8, 9, 10  # FILLED: virtual particles over those of the fluid
INERTIA, INVERSE_INERTIA, ROOT_INERTIA = 11, 17, 23
HINGED, HINGE = 29, 30
FORCE_GIVEN, TORQUE_GIVEN, IN_BODY_FRAME = 33, 36, 39  # constant force and torque
SPRING, ANGULAR_SPRING, TOWARDS = 40, 41, 42
DEPTH, RANGE = 45, 46  # of the potential of gaps; DEPTH 0 for none
B1, B2, TUMBLES = 47, 48, 49
FIRST_PART, PARTS_END = 50, 51
DISPLACED, HALF_LENGTH = 52, 53  # mass of fluid in its place; from its centre along axis x
# The fluid in a ball takes the counter-force of BALL_FORCE, that in a shell the counter-torque of
# SHELL_TORQUE; 0 for none. REACH: from the centre to all of these; SWEPT: as far as its turns move
# anything.
BALL_AT, BALL_RADIUS, BALL_FORCE = 54, 57, 58
SHELL, SHELL_TORQUE = 61, 62
REACH, SWEPT = 65, 66
KIND_COLUMNS = 67

# Columns of a particle near bodies.
R, V, START, START_V, TIME, ARM, NORMAL, SHEAR = 0, 3, 6, 9, 12, 13, 16, 19
NEAR_COLUMNS = 20
LANE, CELL, BODY, LEFT, GOING, IMAGE = 0, 1, 2, 3, 4, 5  # whole numbers of one
NEAR_NUMBERS = 8

MOST_NEAR_CELL = 8  # bodies on the list of a cell; with more, all bodies are tried
EVERY_BODY = -1
SPARE = 0.01  # cells by which hits may lengthen the path of a body in a step, beyond doubling it
NO_BODY = -1
MOST_PARTNERS = 48  # bodies on the list of another one
SUMS = 27  # whole numbers of a body that threads add up
# Columns of an entry of the gas of a body: the last are the speed of its image along x, its mass,
# and the sum of m v^2 of its particles about their mean velocity.
GAS_PLACE, GAS_VELOCITY, GAS_KEPT, GAS_ARM = 0, 3, 6, 9
GAS_SPEED, GAS_MASS, GAS_INNER = 12, 13, 14
GAS_COLUMNS = 15
# Counters of a thread.
COUNT, HITS, SECOND_HITS, PUT_BACK, GAS_COUNT, STILL_HITTING, BATCHED = range(7)
COUNTERS = 8
CAUGHT, TOO_FAST = 4, 5  # what a fault may be, beside those of `embedded.state`
SPEED, MILLIONTH = 3, 1e-6  # of a fault: where the speed of a body is, and in what
ROWS = 27  # of scratch memory for flights, and for cells that wait for their gas
WORK = 256  # floats of scratch memory of a thread


class MovingBodies(NamedTuple):
    """Bodies, the particles near them, and the gas in the cells that they cut.

    rows (bodies, COLUMNS), kinds (kinds, KIND_COLUMNS), kind (bodies,): of each; part_code (parts,)
    and parts: code and address of the numbers of the primitives that kinds consist of.
    mass_scale: whole numbers per unit of mass in sums; cells, density: of the fluid;
    substeps: of the motion of bodies.
    lever: a power of two not below the largest radius: arms are counted in it. further: what walls
    may add to the path of a particle in a timestep. twice: 1 where hits are found once more with
    the mean motion, else 0.
    grid: cells of the box, without shift; halves: cubes of half the size; cubes (threads, LANES):
    scratch memory; list_reach: the lists have the bodies whose surface is so near, and nearly all
    flights in a timestep are shorter; near_count (cells + 1,), near (cells + 1, MOST_NEAR_CELL):
    the bodies near each cell; alone (cells + 1,): the only body on its list, NO_BODY or SEVERAL;
    clear (cubes + 1,): the distance that is clear around each cube. partner_count (bodies,),
    partners (bodies, MOST_PARTNERS): other bodies that may come near.
    values (threads, most, NEAR_COLUMNS), numbers (threads, most, NEAR_NUMBERS): particles near.
    sums (threads, bodies, SUMS): of the hits in hand; taken (threads, bodies, 6): impulses, in
    whole numbers. gas (threads, most, GAS_COLUMNS): virtual particles, of gas_mass, or all of a
    cell that a ball cuts; gas_number, gas_cell, gas_body (threads, most): number, cell and body of
    each entry. together: 1 where the rule lets those of a cell be drawn at once, else 0.
    tensor (threads, 2, 2 d^2): terms of the stress, before and after the collision.
    counters (threads, COUNTERS); faults (threads, 8): the first thing that goes wrong; work
    (threads, WORK), chosen (threads, LANES), columns (threads, ROWS * SCRATCH_ROW): scratch memory;
    keys (threads, 4, LANES): of each cell that waits for its gas the key, the cell and the body,
    and the keys of those without a place; waste: what walls take by flights that do not count.
    counters_near: (1,) where the fluid near bodies takes counter-forces, else ().
    solid: walls as the potential of gaps sees them, or (). pull: the uniform acceleration of all
    that balances forces on bodies. messages: to other ranks, or ().
    """

    rows: Any
    kinds: Any
    kind: Any
    part_code: Any
    table: Any
    parts: int
    mass_scale: float
    cells: int
    density: float
    substeps: int
    lever: float
    further: float
    twice: int
    grid: tuple
    halves: tuple
    cubes: Any
    list_reach: float
    near_count: Any
    near: Any
    alone: Any
    clear: Any
    partner_count: Any
    partners: Any
    values: Any
    numbers: Any
    sums: Any
    taken: Any
    gas: Any
    gas_mass: float
    together: int
    gas_number: Any
    gas_cell: Any
    gas_body: Any
    tensor: Any
    counters: Any
    faults: Any
    work: Any
    chosen: Any
    columns: Any
    keys: Any
    waste: Any
    counters_near: tuple
    solid: tuple
    pull: tuple
    messages: Any


THREE = (0.0, 0.0, 0.0)
FOUR = (1.0, 0.0, 0.0, 0.0)


@elementwise
def load(rows, i, column, pattern):
    """Numbers of row i from a column on, as a tuple as long as the pattern."""
    return "rows[i, column + {k}]"


@scalar
def store(rows, i, column, values):
    """Write a tuple to row i from a column on."""
    for k in range(len(values)):
        rows[i, column + k] = values[k]


@scalar
def of_kind(bodies, i, column):
    """A number of the kind of body i."""
    return bodies.kinds[bodies.kind[i], column]


# --- rotations ------------------------------------------------------------------------------------


@by_type
def rotated(q, a):
    """The vector a, rotated by a unit quaternion."""
    if len(a) == 2:
        return lambda q, a: _turned_in_plane(q[0], q[3], a)
    return lambda q, a: _turned(q[0], (q[1], q[2], q[3]), a)


@by_type
def rotated_back(q, a):
    """The vector a, rotated by the inverse."""
    if len(a) == 2:
        return lambda q, a: _turned_in_plane(q[0], -q[3], a)
    return lambda q, a: _turned(-q[0], (q[1], q[2], q[3]), a)


@scalar
def _turned_in_plane(w, z, a):
    c, s = w * w - z * z, 2.0 * w * z
    return (c * a[0] - s * a[1], s * a[0] + c * a[1])


@scalar
def _turned(w, u, a):
    # a + 2 w (u x a) + 2 u x (u x a)
    x = 2.0 * (u[1] * a[2] - u[2] * a[1])
    y = 2.0 * (u[2] * a[0] - u[0] * a[2])
    z = 2.0 * (u[0] * a[1] - u[1] * a[0])
    return (
        a[0] + w * x + (u[1] * z - u[2] * y),
        a[1] + w * y + (u[2] * x - u[0] * z),
        a[2] + w * z + (u[0] * y - u[1] * x),
    )


@scalar
def after_turn(q, spin, time):
    """The orientation after a uniform turn; a unit quaternion again."""
    return turned_on(q, spin, rate_of(spin), time)


@scalar
def rate_of(spin):
    """The size of an angular velocity, and one over it (0 for 0)."""
    fast = np.sqrt(spin[0] * spin[0] + spin[1] * spin[1] + spin[2] * spin[2])
    return fast, 1.0 / fast if fast > 0.0 else 0.0


@seldom
def turned_on(q, spin, rate, time):
    """The same for an angular velocity whose rate is given."""
    half = rate[0] * time * (0.25 / np.pi)  # turns of half the angle
    s, c = sincos_turn(half - floor(half))
    s *= rate[1]
    x, y, z = s * spin[0], s * spin[1], s * spin[2]
    w = (
        c * q[0] - x * q[1] - y * q[2] - z * q[3],
        c * q[1] + x * q[0] + y * q[3] - z * q[2],
        c * q[2] + y * q[0] + z * q[1] - x * q[3],
        c * q[3] + z * q[0] + x * q[2] - y * q[1],
    )
    size = 1.0 / np.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3])
    return (w[0] * size, w[1] * size, w[2] * size, w[3] * size)


@by_type
def swept(spin, s):
    """Velocity of a place by rotation: spin x s."""
    if len(s) == 2:
        return lambda spin, s: (-spin[2] * s[1], spin[2] * s[0])
    return lambda spin, s: (
        spin[1] * s[2] - spin[2] * s[1],
        spin[2] * s[0] - spin[0] * s[2],
        spin[0] * s[1] - spin[1] * s[0],
    )


@by_type
def whole_spin(t):
    """An angular velocity or torque with three components."""
    if len(t) == 1:
        return lambda t: (0.0, 0.0, t[0])
    return lambda t: t


@scalar
def apply_symmetric(kinds, kind, column, a):
    """A symmetric matrix of a kind times a vector of three, both in the body's frame."""
    m = load(kinds, kind, column, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return (
        m[0] * a[0] + m[3] * a[1] + m[4] * a[2],
        m[3] * a[0] + m[1] * a[1] + m[5] * a[2],
        m[4] * a[0] + m[5] * a[1] + m[2] * a[2],
    )


@seldom
def turn_by(bodies, i, q, column, a):
    """A symmetric matrix of the kind of body i, at an orientation, times a vector of three."""
    return rotated(q, apply_symmetric(bodies.kinds, bodies.kind[i], column, rotated_back(q, a)))


@seldom
def spin_of(bodies, i, q, angular_momentum):
    """Angular velocity at an orientation: about the hinge alone where there is one."""
    kind = bodies.kind[i]
    if bodies.kinds[kind, HINGED] > 0.5:
        h = load(bodies.kinds, kind, HINGE, THREE)
        along = h[0] * angular_momentum[0] + h[1] * angular_momentum[1] + h[2] * angular_momentum[2]
        about = turn_by(bodies, i, q, INERTIA, h)
        rate = along / (h[0] * about[0] + h[1] * about[1] + h[2] * about[2])
        return (rate * h[0], rate * h[1], rate * h[2])
    return turn_by(bodies, i, q, INVERSE_INERTIA, angular_momentum)


# --- shapes ---------------------------------------------------------------------------------------


@seldom
def clearance(bodies, kind, y):
    """Distance of a place in the body's frame from its surface."""
    first, end = int(bodies.kinds[kind, FIRST_PART]), int(bodies.kinds[kind, PARTS_END])
    least = np.inf
    for part in range(first, end):
        p = bodies.parts + 8 * WIDTH * part
        least = min(least, primitive.distance(bodies.part_code[part], p, bodies.parts, y))
    return least


@seldom
def distance_of(bodies, kind, q, s):
    """Distance of a place at an arm s from the surface of a body of a kind, negative inside."""
    if bodies.kinds[kind, IS_BALL] > 0.5:
        return math.sqrt(dot(s, s)) - bodies.kinds[kind, RADIUS]
    return clearance(bodies, kind, rotated_back(q, s))


@seldom
def is_nearer(bodies, kind, q, s, reach):
    """Whether a place at an arm s is nearer to the surface of a body of a kind than a reach."""
    if bodies.kinds[kind, IS_BALL] > 0.5:
        return math.sqrt(dot(s, s)) - bodies.kinds[kind, RADIUS] < reach
    y = rotated_back(q, s)
    for part in range(int(bodies.kinds[kind, FIRST_PART]), int(bodies.kinds[kind, PARTS_END])):
        p = bodies.parts + 8 * WIDTH * part
        if primitive.nearer(bodies.part_code[part], p, bodies.parts, y, reach):
            return True
    return False


@seldom
def facing(bodies, kind, y):
    """Distance of a place in the body's frame from its surface, and the normal of the part that is
    nearest."""
    first, end = int(bodies.kinds[kind, FIRST_PART]), int(bodies.kinds[kind, PARTS_END])
    least, out = np.inf, y
    for part in range(first, end):
        p = bodies.parts + 8 * WIDTH * part
        c, normal = primitive.facing(bodies.part_code[part], p, bodies.parts, y)
        if c < least:
            least, out = c, normal
    return least, out


@seldom
def heights_on_flight(bodies, kind, y, flight):
    """Distance of a place in the body's frame from its surface, and the least height above it to
    which a straight flight may lead.

    Parts are convex: each lies behind the plane that touches it where it is nearest to the place.
    """
    first, end = int(bodies.kinds[kind, FIRST_PART]), int(bodies.kinds[kind, PARTS_END])
    least, lowest = np.inf, np.inf
    for part in range(first, end):
        p = bodies.parts + 8 * WIDTH * part
        c, normal = primitive.facing(bodies.part_code[part], p, bodies.parts, y)
        least, lowest = min(least, c), min(lowest, c + min(dot(normal, flight), 0.0))
    return least, lowest


@scalar
def add_threads(sums, i):
    """Add the sums of all threads for body i to those of the first thread."""
    for t in range(1, sums.shape[0]):
        for k in range(sums.shape[2]):
            sums[0, i, k] += sums[t, i, k]


# --- images ---------------------------------------------------------------------------------------


@by_type
def image_near(box, x, r):
    """The periodic image of x that is nearest to r, and the speed of that image along x."""
    return _sliding_image if box.instance_class in SLIDING else _image


def _image(box, x, r):
    return added(x, _boxes(box, x, r)), 0.0


@elementwise
def _boxes(box, x, r):
    return "box.size[{k}] * rint((r[{k}] - x[{k}]) * box.inverse[{k}])"


def _sliding_image(box, x, r):
    up = rint((r[1] - x[1]) * box.inverse[1])
    x = with_item(x, 0, x[0] + up * box.offset)
    return added(x, _boxes(box, x, r)), up * box.speed


@scalar
def with_shear(v, speed):
    """The velocity of an image that slides along x."""
    return with_item(v, 0, v[0] + speed)


@scalar
def rigid_velocity(v, spin, s, speed):
    """Velocity of a rigid body at s from its centre, in an image with a speed along x."""
    return with_shear(added(v, swept(spin, s)), speed)


@scalar
def place_at(bodies, i, x, speed, time):
    """Where the centre of an image is, a time after the beginning of the step."""
    u = with_shear(load(bodies.rows, i, MEAN_VELOCITY, x), speed)
    return added_scaled(x, time, u)
