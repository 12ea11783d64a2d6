"""The terms of the stress: rows of d x d numbers, the kinetic before the collisional.

Whole numbers, `scale` of which are one unit of m v^2: the sums do not depend on their order.
"""

from mesokit.case.box import peculiar
from mesokit.scalar.fixed_point import add_quanta
from mesokit.scalar.intrinsics import floor  # noqa: F401  the text of a function below uses it
from mesokit.scalar.jit import elementwise, scalar
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
    add_quanta(tensor, scale, products(scaled(factor, a), b))


@elementwise
def within_cell(x):
    """A place relative to the corner of its cell, in cells."""
    return "x[{k}] - floor(x[{k}])"
