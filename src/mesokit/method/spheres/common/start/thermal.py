"""Velocities and spins in equilibrium."""

import numpy as np

from mesokit.method.spheres.common.draws import normal_rows
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.protocol import Array

VELOCITIES, SPINS = 61, 62  # purposes of random numbers, above METHOD


def velocities(seed: int, made: Made, kT: float, dimension: int, at_rest: bool = True) -> Array:
    """Maxwellian velocities (n, d); of zero total momentum if `at_rest`, with exactly the thermal
    energy that these degrees of freedom have: m v^2 adds up to (n - 1) d kT, or n d kT.
    """
    n = len(made.masses)
    v = normal_rows(seed, 0, VELOCITIES, n, dimension) / np.sqrt(made.masses)[:, None]
    degrees = n * dimension
    if at_rest and n > 1:
        v -= made.masses @ v / made.masses.sum()
        degrees -= dimension
    return _scaled(v, made.masses, degrees, kT)


def spins(seed: int, made: Made, kT: float, dimension: int) -> Array:
    """Maxwellian angular velocities, (n,) in 2D and (n, 3) in 3D."""
    n, axes = len(made.masses), 1 if dimension == 2 else 3
    w = normal_rows(seed, 0, SPINS, n, 3)[:, :axes] / np.sqrt(made.inertia)[:, None]
    w = _scaled(w, made.inertia, n * axes, kT)
    return w[:, 0] if dimension == 2 else w


def _scaled(v: Array, weights: Array, degrees: int, kT: float) -> Array:
    twice = float(weights @ (v * v).sum(axis=1))
    return v * np.sqrt(kT * degrees / twice) if twice > 0 else v
