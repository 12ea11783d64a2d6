"""The memory of the loops of soft spheres, by name.

A row of four numbers is one half of a cache line, so that all data of a neighbour arrive at once.
"""

from typing import Any, NamedTuple

REACH = 3  # column of `place`: how far a sphere reaches, a radius or half of a cut-off
INVERSE = 3  # column of `velocity` and `spin`: the inverse of mass and of moment of inertia
FARTHEST, NEAREST, LARGEST, DONE, PENDING = range(5)  # columns of `noted` of a thread
ENERGY, VIRIAL, TOUCHING, READINGS = 0, 1, 7, 8  # columns of the readings of a sphere


class Bodies(NamedTuple):
    """The spheres in the order of memory.

    place (n, 4): coordinates in the box and reach; velocity (n, 4): and inverse mass; seen (n, 4):
    velocity for dashpots along the normal; spin (n, 4): angular velocity and inverse moment of
    inertia; force, torque (n, 3): in whole quanta; images (n, 3): boxes away; number (n,): of the
    particle.
    """

    place: Any
    velocity: Any
    seen: Any
    spin: Any
    force: Any
    torque: Any
    images: Any
    number: Any


class Box(NamedTuple):
    """Lengths and their inverses; the inverse is 0 along axes that do not repeat."""

    size: tuple[float, float, float]
    inverse: tuple[float, float, float]


class Lists(NamedTuple):
    """Neighbour lists, by places in memory.

    skin: how far lists go beyond the reach; halves: whether laws take each pair once; count (n,)
    and near (n, most): the lists, filled up to whole groups of eight with the sphere itself; own
    (n,): how many, from the front, this sphere finds, where each pair is taken once; begin (n,):
    its first contact, and springs (contacts, width); made_at (n, 4): where the
    spheres were.
    """

    skin: float
    halves: bool
    count: Any
    own: Any
    near: Any
    begin: Any
    springs: Any
    made_at: Any


class Walls(NamedTuple):
    """rows (walls, 14): see `common.walls`; own (walls, 2): damping ratio and friction of
    each; springs (n * walls, width) of contacts; solid: walls of other shapes, see `solid`."""

    rows: Any
    own: Any
    springs: Any
    solid: Any


class Solid(NamedTuple):
    """Walls of any shape: tables of `geometry.solids`, pattern: a place in the box; own
    (bodies, 2): damping ratio and friction of each; terms (n, 3): which terms a sphere touches, -1
    where it touches none; springs (n * 3, width): of these contacts."""

    bodies: Any
    pattern: Any
    own: Any
    terms: Any
    springs: Any


class World(NamedTuple):
    """The spheres, the box, the neighbour lists and the walls."""

    bodies: Bodies
    box: Box
    lists: Lists
    walls: Walls


class Motion(NamedTuple):
    """The time of a step, gravity, and of Langevin's bath: by how much velocities decay in a step
    (1 without), and its thermal energy; axes: 1 along each there is; turns: 1 about
    each there is."""

    step: float
    gravity: tuple[float, float, float]
    decay: float
    kT: float
    axes: tuple[float, float, float]
    turns: tuple[float, float, float]
