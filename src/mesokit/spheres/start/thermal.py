"""Velocities and spins in equilibrium."""

from __future__ import annotations

import numpy as np

from mesokit.scalar.cache import kernel
from mesokit.scalar.random import METHOD, Counter, normals, words
from mesokit.spheres.made import Made
from mesokit.spheres.start.protocol import Array

VELOCITIES, SPINS = METHOD + np.uint64(1001), METHOD + np.uint64(1002)  # purposes of random numbers


def velocities(seed: int, made: Made, kT: float, dimension: int, at_rest: bool = True) -> Array:
    """Maxwellian velocities (n, d); of zero total momentum if `at_rest`, with exactly the thermal
    energy that these degrees of freedom have: m v^2 adds up to (n - 1) d kT, or n d kT.
    """
    n = len(made.masses)
    v = np.empty((n, dimension))
    draw_normals(Counter(np.uint64(seed), np.uint64(0)), VELOCITIES, v, (0.0,) * dimension)
    v /= np.sqrt(made.masses)[:, None]
    degrees = n * dimension
    if at_rest and n > 1:
        v -= made.masses @ v / made.masses.sum()
        degrees -= dimension
    return _scaled(v, made.masses, degrees, kT)


def spins(seed: int, made: Made, kT: float, dimension: int) -> Array:
    """Maxwellian angular velocities, (n,) in 2D and (n, 3) in 3D."""
    n, axes = len(made.masses), 1 if dimension == 2 else 3
    w = np.empty((n, 3))
    draw_normals(Counter(np.uint64(seed), np.uint64(0)), SPINS, w, (0.0,) * 3)
    w = w[:, :axes] / np.sqrt(made.inertia)[:, None]
    w = _scaled(w, made.inertia, n * axes, kT)
    return w[:, 0] if dimension == 2 else w


def _scaled(v: Array, weights: Array, degrees: int, kT: float) -> Array:
    twice = float(weights @ (v * v).sum(axis=1))
    return v * np.sqrt(kT * degrees / twice) if twice > 0 else v


@kernel
def draw_normals(counter, purpose, numbers, zero):
    """Normal random numbers, a row for each sphere."""
    for i in range(len(numbers)):
        a, b, c, d = words(counter, purpose, i, 0)
        xi = normals(zero, a, b, c, d)
        for k in range(len(zero)):
            numbers[i, k] = xi[k]
