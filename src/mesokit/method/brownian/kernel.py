"""The loops over particles: each goes its own way, by random numbers of its own."""

from typing import NamedTuple

import numpy as np

from mesokit.kernels.kernel import kernel
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import INITIAL_POSITION, METHOD, Counter, normals, unit, words


class Motion(NamedTuple):
    """Standard deviation of a step along each axis, and the lengths of the box."""

    spread: float
    size: tuple[float, ...]


@scalar
def moved(motion, counter, number, r):
    """The place of a particle after one step, anywhere in space."""
    a, b, c, d = words(counter, METHOD, number, 0)
    xi = normals(r, a, b, c, d)
    for k in range(len(r)):
        r = with_item(r, k, r[k] + motion.spread * xi[k])
    return r


@scalar
def folded(length, x):
    """A coordinate brought back into the box, and how many boxes away it was."""
    away = floor(x / length)
    inside = x - away * length
    return (inside if inside < length else 0.0), away


@kernel
def scatter(first, last, counter, size, places):
    """Places uniform in the box, for the particles with numbers from `first` to `last` - 1."""
    for i in range(first, last):
        for k in range(len(size)):
            high, low, _, _ = words(counter, INITIAL_POSITION, i, k)
            places[i, k] = size[k] * unit(high, low)


@kernel
def wander(first, last, counter, steps, motion, places, images):
    """So many steps of these particles."""
    # All steps of one particle, then the next one: places stay in registers. Random numbers follow
    # from particle and step, so the order of the two loops and shares of threads change no bit.
    for i in range(first, last):
        r = motion.size
        for k in range(len(r)):
            r = with_item(r, k, places[i, k])
        for done in range(steps):
            now = Counter(counter.seed, counter.step + np.uint64(done))
            r = moved(motion, now, i, r)
            for k in range(len(r)):
                inside, away = folded(motion.size[k], r[k])
                r = with_item(r, k, inside)
                images[i, k] += np.int32(away)
        for k in range(len(r)):
            places[i, k] = r[k]
