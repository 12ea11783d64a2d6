"""Sums of forces and torques in whole quanta: they have no order."""

import numpy as np

from mesokit.method.soft_spheres.machine.geometry import row
from mesokit.scalar.jit import scalar


@scalar
def counted(total, vector, scale):
    """A sum in whole quanta, and a vector more: cut off toward zero, so that what the other sphere
    adds is exactly minus this."""
    return (
        total[0] + np.int64(vector[0] * scale),
        total[1] + np.int64(vector[1] * scale),
        total[2] + np.int64(vector[2] * scale),
    )


@scalar
def count(sums, i, vector, scale):
    """Add a vector to those of sphere i, in whole quanta."""
    a, b, c = counted(row(sums, i), vector, scale)
    sums[i, 0], sums[i, 1], sums[i, 2] = a, b, c


@scalar
def opposite(vector):
    """Minus a vector."""
    return -vector[0], -vector[1], -vector[2]


@scalar
def abs_sum(vector):
    """A bound of the numbers of a vector; infinite where one is none."""
    found = abs(vector[0]) + abs(vector[1]) + abs(vector[2])
    return found if found >= 0.0 else np.inf
