"""The clear distance around particles, looked up for some lanes together.

Particles of a strip lie next to one another, sorted by cell. If all of some lanes are far from all
solids, tables are not read again until one of them may be near. Functions that take views of arrays
are declared by `where`, for then numba does not count the users of these arrays.
"""

import math

import numpy as np

from mesokit.geometry.solids.bodies import Bodies, cube_of
from mesokit.loops.layout import LANES, ROW
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.pointer import whole

FEW = 64  # lanes: of particles next to one another, which are all near a solid or all far
MOST_ROOM = 1e6
ROUNDED_DOWN = 1.0 - 1e-6  # of numbers that float32 may have rounded up


@by_type
def lanes_together(solid):
    """The number of lanes with one clear distance: a strip, or fewer for solids in tables."""
    number = FEW if solid.instance_class is Bodies else LANES
    return lambda solid: number


@where("0", solid=lambda solid: solid.instance_class is Bodies)
def look_around_strip(solid, strip, s, calm, clear, pattern):
    """The clear distance of each particle of strip s, plates not counted, at most a stride.

    It is found for as many lanes at once as `lanes_together` has. `calm` is the distance that is
    surely clear around every particle of such a part, of plates and of all else: each step takes
    off a stride, until it is found anew. The result has a bit for each part: whether a stride is
    clear, plates or not.
    """
    quiet = 0
    # 64 neighbours in memory share a budget of clear distance, in cells, from plates and from other
    # solids. Every flight takes at most a stride of it; `forget` clears it after a longer one.
    # So tables are read only when the budget is used up.
    for part in range(LANES // FEW):
        n, start = s * (LANES // FEW) + part, part * FEW
        if calm[1, n] < solid.stride:
            calm[1, n] = room_between_plates(solid, strip[start:], clear[start:], pattern)
        look_up(solid, strip[start:], n, calm, clear[start:], pattern)
        if (calm[0, n] >= solid.stride) & (calm[1, n] >= solid.stride):
            quiet |= 1 << part
        calm[0, n] -= solid.stride
        calm[1, n] -= solid.stride
    return quiet


@where()
def look_up(solid, strip, n, calm, clear, pattern):
    """The distance around each particle of the nth part, and the least of them if it is not known.

    `clear` holds the bits of float32 numbers: those of positive numbers are in the same order, and
    the least of whole numbers is found faster.
    """
    stride = np.int32(np.float32(solid.stride * solid.stride).view(np.int32))
    # Three loops instead of one: the first and the last become vectors, between them is the gather
    # from the table. Clearances are squares in float32, rounded down.
    if calm[0, n] < solid.stride:
        for i in range(FEW):
            clear[i] = cube_of(solid, load_particle(strip, i, 0, pattern))
        for i in range(FEW):
            clear[i] = np.int32(whole(solid.clear, np.int64(clear[i])))
        least = np.int32(np.iinfo(np.int32).max)
        for i in range(FEW):
            least = min(least, clear[i])
            clear[i] = min(stride, clear[i])
        calm[0, n] = math.sqrt(np.int32(least).view(np.float32))
    else:
        for i in range(FEW):
            clear[i] = stride


@where()
def room_between_plates(solid, strip, clear, pattern):
    """The least distance of the particles of the part from plates; `clear` is scratch memory."""
    least = np.int32(np.float32(MOST_ROOM).view(np.int32))
    # Axis by axis, as plates lie across axes; a coordinate beyond a plate has no room at all.
    for k in range(len(pattern)):
        if solid.lowest[k] > -np.inf:
            for i in range(FEW):
                x = strip[k * ROW + i]
                room = max(min(x - solid.lowest[k], solid.highest[k] - x), 0.0)
                clear[i] = np.float32(room).view(np.int32)
            for i in range(FEW):
                least = min(least, clear[i])
    return np.int32(least).view(np.float32) * ROUNDED_DOWN


@scalar
def forget(calm, s, far):
    """Set the clear distance to 0 for the parts of a strip that have bits in `far`."""
    for part in range(LANES // FEW):
        if (far >> part) & 1 != 0:
            n = s * (LANES // FEW) + part
            calm[0, n] = calm[1, n] = 0.0
