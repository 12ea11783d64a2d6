"""Where the beads of molecules lie while they move: WIDTH molecules side by side.

The strips of a group lie far apart in memory. For the many passes of a timestep some molecules at a
time are copied to one small stretch, which the first-level cache holds: for each bead a row of each
coordinate, each component of the velocity, and of the place from which the timestep started.
"""

# ruff: noqa: F401  lines written out as text use what is imported here

import numpy as np

from mesokit.box import SLIDING, unfold
from mesokit.execute.rows import load, store
from mesokit.scalar import added_scaled, by_type, elementwise, for_each, scalar

WIDTH = 32  # the rows of ten beads take half a first-level cache


@scalar
def bead_size(d):
    """Length of the rows of one bead."""
    return 3 * d * WIDTH


@scalar
def bead_of(work, number, like):
    """The rows of one bead."""
    size = bead_size(len(like))
    return work[number * size : (number + 1) * size]


@elementwise
def look(bead, i, row, like):
    """Lane i of consecutive rows of a bead, as a tuple as long as `like`."""
    return "bead[(row + {k}) * WIDTH + i]"


@for_each
def leave(bead, i, row, values):
    """Write a tuple into lane i of consecutive rows of a bead."""
    return "bead[(row + {k}) * WIDTH + i] = values[{k}]"


@elementwise
def counts(image, i, like):
    """Boxes that lane i of a strip is away, as floats."""
    return "np.float64(image[{k}, i])"


@for_each
def forget(image, i, values):
    """Write the counts of boxes of lane i of a strip."""
    return "image[{k}, i] = np.int32(values[{k}])"


@by_type
def take_bead(box, strip, image, leader, bead, like):
    """Copy lanes of a strip, which begins where they do, to the rows of a bead.

    Under shear beads are folded one by one: here they go back to the image of the first bead of
    their molecule, whose counts of boxes are `leader`, and have its counts.
    """
    return _take_unfolded if box.instance_class in SLIDING else _take


def _take(box, strip, image, leader, bead, like):
    d = len(like)
    for i in range(WIDTH):
        leave(bead, i, 0, load(strip, i, 0, like) + load(strip, i, d, like))


def _take_unfolded(box, strip, image, leader, bead, like):
    d = len(like)
    for i in range(WIDTH):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        first, own = counts(leader, i, like), counts(image, i, like)
        r, v = unfold(box, r, v, added_scaled(own, -1.0, first))
        leave(bead, i, 0, r + v)
        forget(image, i, first)


@scalar
def put_bead(strip, bead, like):
    """Copy the rows of a bead back to lanes of a strip."""
    for i in range(WIDTH):
        store(strip, i, 0, look(bead, i, 0, like + like))
