"""The memory of the beads of molecules in flight: WIDTH molecules side by side.

The strips of a group lie far apart in memory. For the many passes of a timestep some molecules at a
time are copied to one small stretch, which the first-level cache holds: for each bead a row of each
coordinate, each component of the velocity, and of the place from which the timestep started.
"""

# ruff: noqa: F401  lines written out as text use what is imported here

import numpy as np

from mesokit.case.box import SLIDING, unfold
from mesokit.method.mpcd.engine.cpu.strips.rows import load_particle, store_particle
from mesokit.scalar.jit import by_type, elementwise, for_each, scalar
from mesokit.scalar.vector import added_scaled

WIDTH = 32  # the rows of ten beads take half a first-level cache


@scalar
def bead_size(d):
    """Length of the rows of one bead."""
    return 3 * d * WIDTH


@scalar
def bead_at(number, zero):
    """The part of the work space that holds the rows of one bead (see `loops.layout.strip_at`)."""
    size = bead_size(len(zero))
    return slice(number * size, (number + 1) * size)


@elementwise
def load_bead(bead, i, row, zero):
    """Lane i of consecutive rows of a bead, as a tuple as long as `zero`."""
    return "bead[(row + {k}) * WIDTH + i]"


@for_each
def store_bead(bead, i, row, values):
    """Write a tuple into lane i of consecutive rows of a bead."""
    return "bead[(row + {k}) * WIDTH + i] = values[{k}]"


@elementwise
def load_images(image, i, zero):
    """Boxes that lane i of a strip is away, as floats."""
    return "np.float64(image[{k}, i])"


@for_each
def store_images(image, i, values):
    """Write the counts of boxes of lane i of a strip."""
    return "image[{k}, i] = np.int32(values[{k}])"


@by_type
def strip_to_bead(box, strip, image, leader, bead, zero):
    """Copy lanes of a strip, which begins where they do, to the rows of a bead.

    Under shear beads are folded one by one: here they go back to the image of the first bead of
    their molecule, whose counts of boxes are `leader`, and have its counts.
    """
    return _take_unfolded if box.instance_class in SLIDING else _take


def _take(box, strip, image, leader, bead, zero):
    d = len(zero)
    for i in range(WIDTH):
        store_bead(bead, i, 0, load_particle(strip, i, 0, zero) + load_particle(strip, i, d, zero))


def _take_unfolded(box, strip, image, leader, bead, zero):
    d = len(zero)
    for i in range(WIDTH):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        first, own = load_images(leader, i, zero), load_images(image, i, zero)
        r, v = in_image_of(box, r, v, own, first)
        store_bead(bead, i, 0, r + v)
        store_images(image, i, first)


@scalar
def in_image_of(box, r, v, own, first):
    """Place and velocity of a bead in the image of another, by the boxes that both are away."""
    return unfold(box, r, v, added_scaled(own, -1.0, first))


@scalar
def bead_to_strip(strip, bead, zero):
    """Copy the rows of a bead back to lanes of a strip."""
    for i in range(WIDTH):
        store_particle(strip, i, 0, load_bead(bead, i, 0, zero + zero))
