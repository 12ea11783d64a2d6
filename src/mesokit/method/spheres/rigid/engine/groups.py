"""The memory of the loops of rigid grains, by name."""

from typing import Any, NamedTuple

from mesokit.method.spheres.common.contacts.groups import Lists, Walls

# columns of `Bodies.motion`: velocity from 0, and these; spins are times the radius
INVERSE = 3  # inverse mass, 0 of walls
SPIN = {2: 2, 3: 4}
MOTION = {2: 4, 3: 8}  # columns in 2D and in 3D: half a cache line, and one
# columns of `Found.contact` and `Sorted.contact`: the normal from 0, and these
LEAST, MASS, PUSH, DRAG = 0, 1, 2, 3  # after the normal; drag has one number or three
CONTACT = {2: 8, 3: 12}
ROLL = 8  # columns of what friction against rolling needs
# columns of `noted` of a thread, which has two cache lines
FARTHEST, FASTEST, DONE, WHY, COUNT, CHANGED, LARGEST, SUM, TOUCHING, TOP, DEEPEST = range(11)
SWEEPS, RATIO, MEAN, STEPS, NOTED = 11, 12, 13, 14, 16  # of the last step, and sweeps so far
SHIFT, SPEED, PER_MASS, FORCE, PRESSURE = 0, 1, 0, 1, 2  # columns of state and drive of `Plates`
GOES_ON, OLD_LISTS, NO_ROOM, TOO_FAST = range(4)  # values of WHY
MOST_COLOURS = 60  # contacts that find none of these are updated by one thread


class Bodies(NamedTuple):
    """Grains in the order of memory.

    place (n, 4): coordinates in the box and radius; motion (n, 4 or 8): velocity, inverse mass, and
    angular velocity times the radius; images (n, 3): boxes away; number (n,): of the particle.
    """

    place: Any
    motion: Any
    images: Any
    number: Any


class Law(NamedTuple):
    """The law of contacts.

    friction, restitution, rolling: coefficients; pull, within: force and range of cohesion; turns:
    moment of inertia over mass and radius squared, `stick` that over one more than it, `per_turn`
    its inverse; push_back: share of an overlap; bounces: largest restitution of all; quantum of
    impulses and its inverse, and the same of energies.
    """

    friction: float
    restitution: float
    rolling: float
    pull: float
    within: float
    turns: float
    stick: float
    per_turn: float
    push_back: float
    bounces: float
    quantum: float
    scale: float
    energy_quantum: float
    energy_scale: float


class Motion(NamedTuple):
    """The time of a step, gravity along each axis, the largest speed of walls, and the time when
    lists were made."""

    step: float
    gravity: Any
    walls: float
    made: float


class Found(NamedTuple):
    """Contacts in the order in which threads find them; each thread has a part of the arrays.

    pair (most, 2): places in memory of the grain, and of the other or of the wall's row of
    motion; key (most, 2): the smaller particle number and the other, or n and more for a
    wall; slot (most): where the impulse is remembered; contact (most, 8 or 12): for the
    sweeps; beside (most, 2): gap, and pull of cohesion; roll (most or 0, 8).
    """

    pair: Any
    key: Any
    slot: Any
    contact: Any
    beside: Any
    roll: Any


class Order(NamedTuple):
    """Contacts in the order of sweeps: colour after colour, or by number.

    pair, slot, contact, beside, roll: see `Found`; at (most,): the place here of each that is
    found; by_number (most,): contacts by their keys; colour (most,); begin (n + 1,): first contact
    of each number; used (n,): colours of a grain, as bits; colours (MOST_COLOURS + 2,): where each
    begins; shuffled (most,): the order of a sweep; change (most, 4): of impulses.
    """

    pair: Any
    slot: Any
    contact: Any
    beside: Any
    roll: Any
    at: Any
    by_number: Any
    colour: Any
    begin: Any
    used: Any
    colours: Any
    shuffled: Any
    change: Any


class Plates(NamedTuple):
    """Plates that are pushed. state (walls, 2): how far each has moved into the box, and its speed;
    drive (walls, 3): inverse mass, 0 of all other walls, force, and pressure; first: place of the
    first wall in `World.motion`, where a plate that is pushed has one row for all its contacts."""

    state: Any
    drive: Any
    first: int


class World(NamedTuple):
    """The grains, their box (at rest, or as it slides), lists and walls; motion and before
    (n + most, 4 or 8): of grains and walls, now and at the start of the step; plates: that are
    pushed; flat: a pattern of a vector."""

    bodies: Bodies
    box: Any
    lists: Lists
    walls: Walls
    motion: Any
    before: Any
    plates: Plates
    flat: Any


class Rules(NamedTuple):
    """What does not change in a run: the law of contacts, the solver, motion, shear of the box."""

    law: Law
    solver: Any
    motion: Motion
    shear: Any


class Sums(NamedTuple):
    """noted (threads, 16): numbers of a thread, see the columns above; taken (threads, surfaces +
    1, width): momentum that surfaces have taken, and in the last row energy lost, in quanta."""

    noted: Any
    taken: Any
