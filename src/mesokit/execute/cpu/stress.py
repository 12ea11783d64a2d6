"""What the stress is summed up from: rows of d x d numbers, the kinetic before the collisional.

Whole numbers, `scale` of which are one unit of m v^2: the sums do not depend on their order.
"""

from mesokit.scalar.fixed_point import quanta
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar


@scalar
def add_flux(tensor, scale, m, c, u, x):
    """Add m c c (c relative to the imposed flow), and m u x (x relative to the corner of a cell).

    `x` is given in cells from anywhere on the grid.
    """
    d = len(c)
    for j in range(d):
        for k in range(d):
            tensor[j * d + k] += quanta(m * c[j] * c[k], scale)
            tensor[d * d + j * d + k] += quanta(m * u[j] * (x[k] - floor(x[k])), scale)


@scalar
def add_product(tensor, scale, factor, a, b):
    """Add a factor times the outer product of two vectors."""
    d = len(a)
    for j in range(d):
        for k in range(d):
            tensor[j * d + k] += quanta(factor * a[j] * b[k], scale)
