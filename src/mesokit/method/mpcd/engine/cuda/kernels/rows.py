"""Tuples in rows of a device's memory, whole numbers to add up, and masses of particles."""

# ruff: noqa: F401  the lines below, which are written out as text, use what is imported here

from mesokit.scalar.fixed_point import ROUNDER_BITS
from mesokit.scalar.jit import by_type, elementwise, for_each, scalar
from mesokit.scalar.pointer import put_real, put_whole, real, whole, word


@elementwise
def from_rows(rows, i, pattern):
    """Number i of each of the rows at these addresses."""
    return "real(rows[{k}], i)"


@for_each
def to_rows(rows, i, values):
    """Write a tuple to place i of the rows at these addresses."""
    return "put_real(rows[{k}], i, values[{k}])"


@for_each
def count_crossed(image, i, crossed):
    """Count the boxes that particle i crossed: one number for each axis, or () for none."""
    return "put_whole(image[{k}], i, whole(image[{k}], i) + int(crossed[{k}]))"


@elementwise
def whole_numbers(values):
    """Fixed-point numbers without the bits that rounding has added."""
    return "values[{k}] - ROUNDER_BITS"


@by_type
def mass_of_number(physics, kinds, number):
    """Mass of the particle with a number: that of all, or that of its kind."""
    if len(kinds) == 0:
        return lambda physics, kinds, number: physics.masses[0]

    def of_its_kind(physics, kinds, number):
        kind = 0
        while number >= word(kinds.ends, kind):
            kind += 1
        return real(kinds.masses, kind)

    return of_its_kind
