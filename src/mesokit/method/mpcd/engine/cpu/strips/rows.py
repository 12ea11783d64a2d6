"""Tuples in memory: lanes of the rows of a strip, and consecutive places of an array."""

# ruff: noqa: F401  the lines below, which are written out as text, use what is imported here

import numpy as np

from mesokit.loops.layout import ROW, SCRATCH_ROW
from mesokit.scalar.jit import by_type, elementwise, for_each
from mesokit.scalar.pointer import is_address, put_reals, reals


@elementwise
def load_particle(strip, i, row, pattern):
    """Lane i of consecutive rows of particles, as a tuple as long as `pattern`."""
    return "strip[(row + {k}) * ROW + i]"


@for_each
def store_particle(strip, i, row, values):
    """Write a tuple into lane i of consecutive rows of particles."""
    return "strip[(row + {k}) * ROW + i] = values[{k}]"


@elementwise
def load_scratch(scratch, i, pattern):
    """Lane i of a strip's scratch rows, as a tuple as long as `pattern`."""
    return "scratch[{k} * SCRATCH_ROW + i]"


@for_each
def store_scratch(scratch, i, values):
    """Write a tuple into lane i of a strip's scratch rows."""
    return "scratch[{k} * SCRATCH_ROW + i] = values[{k}]"


@by_type
def load_values(values, start, pattern):
    """Consecutive values of an array from `start` (unsigned), or float64 numbers at an address, as
    a tuple as long as `pattern`."""
    if is_address(values):
        return lambda values, start, pattern: reals(values, np.int64(start), pattern)
    return lambda values, start, pattern: _loaded(values, start, pattern)


@elementwise
def _loaded(values, start, pattern):
    return "values[start + np.uint64({k})]"


@by_type
def store_values(values, start, given):
    """Write a tuple to consecutive places of an array from `start` (unsigned), or as float64
    numbers to an address."""
    if is_address(values):
        return lambda values, start, given: put_reals(values, np.int64(start), given)
    return lambda values, start, given: _stored(values, start, given)


@for_each
def _stored(values, start, given):
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
def lane_mass(masses, strip, i, row):
    """Mass of the particle in lane i: `masses` is (mass,) for all, or () for a row of masses."""
    if len(masses) == 1:
        return lambda masses, strip, i, row: masses[0]
    return lambda masses, strip, i, row: strip[row * ROW + i]
