"""Sums of forces and torques in whole quanta: they have no order."""

import numpy as np

from mesokit.scalar.jit import scalar


@scalar
def counted(vector, scale):
    """A vector in whole quanta, cut off toward zero: minus the vector gives exactly minus this."""
    return (np.int64(vector[0] * scale), np.int64(vector[1] * scale), np.int64(vector[2] * scale))


@scalar
def add(sums, i, counts):
    """Add quanta to those of sphere i."""
    sums[i, 0] += counts[0]
    sums[i, 1] += counts[1]
    sums[i, 2] += counts[2]


@scalar
def subtract(sums, i, counts):
    """Subtract quanta from those of sphere i."""
    sums[i, 0] -= counts[0]
    sums[i, 1] -= counts[1]
    sums[i, 2] -= counts[2]


@scalar
def abs_sum(vector):
    """A bound of the components of a vector; infinite where one is not a number."""
    found = abs(vector[0]) + abs(vector[1]) + abs(vector[2])
    return found if found >= 0.0 else np.inf
