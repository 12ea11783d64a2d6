"""Places and velocities drawn for each particle by its number: in any part, in any order."""

import math

import numpy as np

from mesokit.scalar.cache import kernel
from mesokit.scalar.random import (
    INITIAL_POSITION,
    INITIAL_VELOCITY,
    Counter,
    normals,
    unit,
    words,
)


@kernel
def draw_places(seed, who, attempt, size, places):
    """Places (n, d), uniform in a box of this size (d,), of the particles with these numbers."""
    counter = Counter(np.uint64(seed), np.uint64(0))
    for i in range(len(who)):
        a, b, c, d = words(counter, INITIAL_POSITION, who[i], 2 * attempt)
        e, f, _, _ = words(counter, INITIAL_POSITION, who[i], 2 * attempt + 1)
        drawn = unit(a, b), unit(c, d), unit(e, f)
        for k in range(len(size)):
            places[i, k] = drawn[k] * size[k]


@kernel
def draw_velocities(seed, kT, mass, zero, velocities):
    """Velocities (n, d) of particles at rest on average, of these masses, numbered from 0."""
    counter = Counter(np.uint64(seed), np.uint64(0))
    for i in range(len(mass)):
        a, b, c, d = words(counter, INITIAL_VELOCITY, i, 0)
        v = normals(zero, a, b, c, d)
        for k in range(len(zero)):
            velocities[i, k] = math.sqrt(kT / mass[i]) * v[k]
