"""The memory of the loops of soft spheres, by name.

A row of four numbers is one half of a cache line, so that all data of a neighbour arrive at once.
"""

from typing import Any, NamedTuple

from mesokit.method.spheres.common.contacts.groups import Box, Lists, Walls

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
