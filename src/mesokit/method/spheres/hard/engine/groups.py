"""The memory of the compiled functions, by name.

Spheres lie in memory in an order of their own (places); `number` is the particle number of each.
All times are since the start of the window in which the run is.
"""

from typing import Any, NamedTuple

# columns of `Spheres.state`, a row of 64 bytes for each
TIME, VELOCITY, RADIUS, WIDTH = 3, 4, 7, 8
# columns of `Spheres.body`
MASS, INERTIA, LAST, SPIN, BODY_WIDTH = 0, 1, 2, 3, 6
# columns of `Queue.event`: the partner, and its collisions when predicted (the last 32 bits);
# BIN is -1 for those in the heap, PLACE is where they are in it
PARTNER, PARTNER_HITS, AFTER, PREVIOUS, BIN, PLACE, EVENT_WIDTH = 0, 1, 2, 3, 4, 5, 8
# partner of an event that is with no other sphere
LEAVES, NOTHING = -1, -2  # it leaves the shell of its list; no event
LOST = -3  # a wall, but the search for the time of contact failed
FIRST_WALL = -4  # and below: walls, -4 - number


class HardWorld(NamedTuple):
    """The constants of a window: lengths (d,) of the box, their inverses (d,; 0 along closed axes),
    acceleration (d,), relative growth of diameters per time, walls (walls, 14); lasting: collisions
    sooner than this after another are elastic; instant: a time that counts as none."""

    size: tuple[float, ...]
    inverse: tuple[float, ...]
    gravity: tuple[float, ...]
    growth: float
    walls: Any
    lasting: float
    instant: float


class SphereMemory(NamedTuple):
    """state (n, 8): place, own time, velocity, radius; body (n, 6): mass, moment of inertia, time
    of the last collision, spin; boxes (n, d) away; number (n,); hits (n,): collisions so far."""

    state: Any
    body: Any
    boxes: Any
    number: Any
    hits: Any


class HardLists(NamedTuple):
    """Neighbour lists: pairs that may collide before one of them is `shell` away from its centre.

    widest: largest distance of interaction in the window over the sum of radii; cells, inverse
    (d,): of the grid; centre (n, 4): places where lists were made; cell (n,), head (cells,),
    following (n,), before (n,): the centres of each cell, linked; count (n,), near (n, most): the
    lists; columns (8, most), times (most,): states of one list, and times of their events.
    """

    shell: float
    widest: float
    cells: tuple[int, ...]
    inverse: tuple[float, ...]
    centre: Any
    cell: Any
    head: Any
    following: Any
    before: Any
    count: Any
    near: Any
    columns: Any
    times: Any


class Queue(NamedTuple):
    """The next event of each sphere (Paul 2007): bins of equal time, the current one as a heap.

    time (n,), event (n, 8): when, and the rest by the columns above, where AFTER and PREVIOUS link
    the events of a bin; per_time: bins in a unit of time; first (bins,): of each; heap (n,);
    now (2,): current bin, size of the heap.
    """

    per_time: float
    time: Any
    event: Any
    first: Any
    heap: Any
    now: Any
