"""The terms of the stress: rows of d x d numbers, the kinetic before the collisional.

Whole numbers, `scale` of which are one unit of m v^2: the sums do not depend on their order.
"""

from mesokit.case.box import peculiar
from mesokit.scalar.fixed_point import add_quanta, added_quanta, integers
from mesokit.scalar.intrinsics import floor  # noqa: F401  the text of a function below uses it
from mesokit.scalar.jit import by_type, elementwise, scalar
from mesokit.scalar.pointer import add_words
from mesokit.scalar.vector import added, products, scaled


@scalar
def flux(m, c, u, x):
    """m c c (c relative to the imposed flow) and m u x (x relative to the corner of a cell).

    `x` is given in cells from anywhere on the grid.
    """
    return products(scaled(m, c), c) + products(scaled(m, u), within_cell(x))


@scalar
def carried(box, grid, m, r, v):
    """The same of a particle at r with the velocity v, for the cells of this grid."""
    return flux(m, peculiar(box, r, v), v, added(r, grid.shift))


@scalar
def add_product(tensor, scale, factor, a, b):
    """Add a factor times the outer product of two vectors."""
    add_terms(tensor, scale, products(scaled(factor, a), b))


@by_type
def add_terms(tensor, scale, terms):
    """Add terms, in whole numbers, to an array of one thread or at an address that all share."""
    from numba import types

    if isinstance(tensor, types.Integer):
        return lambda tensor, scale, terms: add_words(
            tensor, 0, added_quanta(terms, scale, integers(terms))
        )
    return lambda tensor, scale, terms: add_quanta(tensor, scale, terms)


@elementwise
def within_cell(x):
    """A place relative to the corner of its cell, in cells."""
    return "x[{k}] - floor(x[{k}])"
