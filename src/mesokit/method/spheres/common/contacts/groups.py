"""The memory of spheres that touch, by name.

A row of four numbers is one half of a cache line, so that all data of a neighbour arrive at once.
"""

from typing import Any, NamedTuple

REACH = 3  # column of `place`: how far a sphere reaches, a radius or half of a cut-off
INVERSE = 3  # column of `velocity`: the inverse of the mass
OPENS = 2  # column of `own` of walls: the time at which they are taken away
NEVER, WITHIN_THREAD, IN_ALL = range(3)  # whether a pair is on the list of one of its two alone


class Box(NamedTuple):
    """Lengths and their inverses; the inverse is 0 along axes that do not repeat."""

    size: tuple[float, float, float]
    inverse: tuple[float, float, float]


class SlidBox(NamedTuple):
    """A box whose image above along y is displaced by `offset` along x (Lees and Edwards 1972) and
    moves at a `speed` against it."""

    size: tuple[float, float, float]
    inverse: tuple[float, float, float]
    offset: float
    speed: float


class Lists(NamedTuple):
    """Neighbour lists, by places in memory.

    skin: how far lists go beyond the reach; once: which pairs are found from one of the two alone,
    NEVER, WITHIN_THREAD or IN_ALL; count (n,) and near (n, most): the lists, filled up to whole
    groups of eight with the sphere itself; own (n,): how many, from the front, this sphere finds,
    where each pair is taken once; begin (n,): its first contact, and springs (contacts, width):
    what these remember; made_at (n, 4): where the spheres were.
    """

    skin: float
    once: int
    count: Any
    own: Any
    near: Any
    begin: Any
    springs: Any
    made_at: Any


class Walls(NamedTuple):
    """rows (walls, 16): see `common.walls`; own (walls, width): properties of each; springs
    (n * walls, width): what contacts remember; solid: walls of other shapes, see `solid`."""

    rows: Any
    own: Any
    springs: Any
    solid: Any


class Solid(NamedTuple):
    """Walls of any shape: tables of `geometry.solids`, pattern: a place in the box; own (bodies,
    width): properties of each; terms (n, 3): which terms a sphere touches, -1 where it touches
    none; springs (n * 3, width): what these contacts remember."""

    bodies: Any
    pattern: Any
    own: Any
    terms: Any
    springs: Any
