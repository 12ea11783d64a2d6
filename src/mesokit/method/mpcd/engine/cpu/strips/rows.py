"""Tuples in memory: lanes of the rows of a strip, and consecutive places of an array."""

# ruff: noqa: F401  the lines below, which are written out as text, use what is imported here

import numpy as np

from mesokit.loops.layout import ROW, SCRATCH_ROW
from mesokit.scalar.jit import by_type, elementwise, for_each


@elementwise
def load_particle(strip, i, row, like):
    """Lane i of consecutive rows of particles, as a tuple as long as `like`."""
    return "strip[(row + {k}) * ROW + i]"


@for_each
def store_particle(strip, i, row, values):
    """Write a tuple into lane i of consecutive rows of particles."""
    return "strip[(row + {k}) * ROW + i] = values[{k}]"


@elementwise
def load_scratch(scratch, i, like):
    """Lane i of a strip's scratch rows, as a tuple as long as `like`."""
    return "scratch[{k} * SCRATCH_ROW + i]"


@for_each
def store_scratch(scratch, i, values):
    """Write a tuple into lane i of a strip's scratch rows."""
    return "scratch[{k} * SCRATCH_ROW + i] = values[{k}]"


@elementwise
def load_values(values, start, like):
    """Consecutive values of an array from `start` (unsigned), as a tuple as long as `like`."""
    return "values[start + np.uint64({k})]"


@for_each
def store_values(values, start, given):
    """Write a tuple to consecutive places of an array from `start` (unsigned)."""
    return "values[start + np.uint64({k})] = given[{k}]"


@for_each
def add_values(values, start, given):
    """Add a tuple to consecutive places of an array from `start` (unsigned)."""
    return "values[start + np.uint64({k})] += given[{k}]"


@for_each
def count_images(image, i, crossed):
    """Count the boxes that particle i crossed: one number for each axis, or () for none."""
    return "image[{k}, i] += np.int32(crossed[{k}])"


@by_type
def mass_of(masses, strip, i, row):
    """Mass of the particle in lane i: `masses` is (mass,) for all, or () for a row of masses."""
    if len(masses) == 1:
        return lambda masses, strip, i, row: masses[0]
    return lambda masses, strip, i, row: strip[row * ROW + i]
