"""Memory for a batch of contacts: rows at constant offsets, one number of each contact in a row.

LLVM can then prove that rows do not overlap, and makes vectors of the loop over contacts.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.loops.layout import zeros
from mesokit.method.spheres.common.contacts.remembered import Springs
from mesokit.method.spheres.common.contacts.taken import WIDTH
from mesokit.method.spheres.soft.engine.contact.force import Meeting
from mesokit.scalar.jit import elementwise, for_each, scalar

BATCH = 64  # contacts; their data fit in the first-level cache
GROUP = 8  # of which so many are a vector at most
ROW = np.uint64(BATCH + 8)
# patterns of `load`
COUNT, VECTOR, MEETING, SPRINGS = (0,) * 3, (0.0,) * 3, (0.0,) * 15, (0.0,) * 6
# first rows of numbers: separation, Meeting, springs, bound of forces
SEPARATION, MET, KEPT, BOUND, NUMBERS = 0, 3, 18, 24, 25
FORCE, TORQUE, BACK, COUNTS = 0, 3, 6, 9  # rows of counts: on the one, and the torque on the other
FIRST, SECOND, PLACE = np.uint64(0), ROW, np.uint64(2) * ROW  # sphere, partner, contact


class Room(NamedTuple):
    """numbers (25 rows), counts in quanta (9 rows) and pairs (3 rows) of a batch of contacts; taken
    (surfaces, 8): momentum of surfaces, see `take`."""

    numbers: Any
    counts: Any
    pairs: Any
    taken: Any


def rooms(threads: int, surfaces: int) -> Room:
    """Room for a batch of each thread."""
    row = int(ROW)
    numbers, counts = zeros((threads, NUMBERS * row)), zeros((threads, COUNTS * row), np.int64)
    pairs, taken = zeros((threads, 3 * row), np.uint64), zeros((threads, surfaces, WIDTH), np.int64)
    return Room(numbers, counts, pairs, taken)


@scalar
def room_of_thread(rooms, t):
    """The room of thread t."""
    return Room(rooms.numbers[t], rooms.counts[t], rooms.pairs[t], rooms.taken[t])


@elementwise
def load(numbers, start, c, pattern):
    """Contact c of consecutive rows, as a tuple as long as `pattern`."""
    return "numbers[np.uint64(start + {k}) * ROW + c]"


@for_each
def store(numbers, start, c, values):
    """Write a tuple into consecutive rows of contact c."""
    return "numbers[np.uint64(start + {k}) * ROW + c] = values[{k}]"


@scalar
def load_meeting(numbers, c):
    """Load the properties of the two spheres of contact c."""
    a = load(numbers, MET, c, MEETING)
    return Meeting(a[0], a[1], a[2], a[3:6], a[6:9], a[9:12], a[12:15])


@scalar
def store_meeting(numbers, c, met):
    """Write the properties of the two spheres of contact c."""
    both = met.reach, met.other, met.inverse
    store(numbers, MET, c, both + met.foreseen + met.velocity + met.rolled + met.turning)


@scalar
def load_springs(numbers, c):
    """Load the springs of contact c."""
    a = load(numbers, KEPT, c, SPRINGS)
    return Springs(a[:3], a[3:])


@scalar
def store_springs(numbers, c, springs):
    """Write the springs of contact c."""
    store(numbers, KEPT, c, springs.sliding + springs.rolling)
