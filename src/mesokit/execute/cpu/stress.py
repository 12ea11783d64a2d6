"""What the stress is summed up from: rows of d x d numbers, the kinetic before the collisional."""

from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import scalar


@scalar
def add_flux(tensor, m, c, u, x):
    """Add m c c (c relative to the imposed flow), and m u x (x relative to the corner of a cell).

    `x` is given in cells from anywhere on the grid.
    """
    d = len(c)
    for j in range(d):
        for k in range(d):
            tensor[j * d + k] += m * c[j] * c[k]
            tensor[d * d + j * d + k] += m * u[j] * (x[k] - floor(x[k]))


@scalar
def add_product(tensor, factor, a, b):
    """Add a factor times the outer product of two vectors."""
    d = len(a)
    for j in range(d):
        for k in range(d):
            tensor[j * d + k] += factor * a[j] * b[k]
