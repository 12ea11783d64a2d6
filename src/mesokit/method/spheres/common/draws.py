"""Random numbers of spheres: by seed, turn, purpose and particle number."""

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.scalar.random import METHOD, Counter, normals, unit, words
from mesokit.seam.engine import Array


def normal_rows(seed: int, turn: int, purpose: int, n: int, width: int) -> Array:
    """Normal random numbers (n, 2 or 3), a row for each sphere by its number."""
    numbers, counter = np.empty((n, width)), Counter(np.uint64(seed), np.uint64(turn))
    draw_normals(counter, METHOD + np.uint64(purpose), numbers, (0.0,) * width)
    return numbers


def uniform_rows(seed: int, turn: int, purpose: int, n: int) -> Array:
    """Uniform random numbers (n,), one for each sphere by its number."""
    numbers, counter = np.empty(n), Counter(np.uint64(seed), np.uint64(turn))
    draw_uniform(counter, METHOD + np.uint64(purpose), numbers)
    return numbers


@kernel
def draw_normals(counter, purpose, numbers, zero):
    for i in range(len(numbers)):
        a, b, c, d = words(counter, purpose, i, 0)
        xi = normals(zero, a, b, c, d)
        for k in range(len(zero)):
            numbers[i, k] = xi[k]


@kernel
def draw_uniform(counter, purpose, numbers):
    for i in range(len(numbers)):
        high, low, _, _ = words(counter, purpose, i, 0)
        numbers[i] = unit(high, low)
