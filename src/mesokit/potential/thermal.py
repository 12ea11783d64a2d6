"""Length of a bond at a temperature, and its stiffness there."""

import functools
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.potential.protocol import central

Floats = NDArray[np.float64]
POINTS = 4001  # of the grid of lengths
NEVER = 40.0  # kT above the lowest energy: a bond is not met there
SOMETIMES = 4.0  # kT above the lowest energy: a bond is met there now and then
SMALLEST, LARGEST = 1e-6, 1e6  # lengths among which bonds are looked for


class Lengths(NamedTuple):
    """Lengths that a bond takes, their energy, and the probability density of each."""

    radii: Floats
    energy: Floats
    density: Floats


def lengths(kernels: Sequence[Any], dimension: int, kT: float, longest: float) -> Lengths:
    """Boltzmann's distribution of the length of a bond whose potentials add up."""
    # kept for the next bond; kernels with the same numbers differ by their classes
    return _lengths(tuple(map(type, kernels)), tuple(kernels), dimension, kT, longest)


@functools.lru_cache(64)
def _lengths(
    kinds: tuple[type, ...], kernels: tuple[Any, ...], dimension: int, kT: float, longest: float
) -> Lengths:
    top = min(longest * (1.0 - 1e-9), LARGEST)
    radii = np.geomspace(SMALLEST, top, POINTS)
    for _ in range(2):  # where they can be at all, and then there in detail
        energy = energies(kernels, radii)
        near = np.flatnonzero(energy - energy.min() <= NEVER * kT)
        low, high = radii[max(near[0] - 1, 0)], radii[min(near[-1] + 1, POINTS - 1)]
        radii = np.linspace(low, high, POINTS)
    energy = energies(kernels, radii)
    weight = radii ** (dimension - 1) * np.exp(-(energy - energy.min()) / kT)
    return Lengths(radii, energy, weight / np.trapezoid(weight, radii))


def energies(kernels: Sequence[Any], radii: Floats) -> Floats:
    """Sum of the potentials at these distances."""
    return np.array([sum(central.plain(k, r * r)[0] for k in kernels) for r in radii.tolist()])


def mean_square(kernels: Sequence[Any], dimension: int, kT: float, longest: float) -> float:
    """Mean square length of a bond that nothing else pulls at."""
    radii, _, density = lengths(kernels, dimension, kT, longest)
    return float(np.trapezoid(radii**2 * density, radii))


def stiffness(kernels: Sequence[Any], kT: float, longest: float) -> float:
    """The largest second derivative of the energy that thermal motion meets."""
    radii, energy, _ = lengths(kernels, 1, kT, longest)
    met = radii[energy - energy.min() <= SOMETIMES * kT]
    force = [-r * sum(central.plain(k, r * r)[1] for k in kernels) for r in met.tolist()]
    return float(np.abs(np.diff(force) / np.diff(met)).max())


def boltzmann_volume(kernel: Any, dimension: int, kT: float, radius: float) -> float:
    """Integral of exp(-U/kT) over a ball: its density times this many ideal particles are in it."""
    radii = np.linspace(0.0, radius, POINTS)
    weight = np.exp(-np.clip(energies((kernel,), radii) / kT, -NEVER, None))
    shell = 2.0 * np.pi * radii if dimension == 2 else 4.0 * np.pi * radii**2
    return float(np.trapezoid(shell * weight, radii))


def excluded_volume(kernel: Any, dimension: int, kT: float, reach: float) -> float:
    """Integral of 1 - exp(-U/kT): by how much less room ideal particles have.

    >>> from mesokit import WCA
    >>> disk = WCA(sigma=3.0)
    >>> round(excluded_volume(disk.kernel(), 2, 1.0, disk.reach) / (3.1416 * 3.0**2), 2)
    1.03
    """
    ball = np.pi * reach**2 if dimension == 2 else 4.0 / 3.0 * np.pi * reach**3
    return float(ball) - boltzmann_volume(kernel, dimension, kT, reach)


def effective_radius(kernel: Any, kT: float, reach: float) -> float:
    """Integral of 1 - exp(-U/kT) along a ray: of the hard sphere that the potential is like."""
    radii = np.linspace(0.0, reach, POINTS)
    return float(np.trapezoid(1.0 - np.exp(-energies((kernel,), radii) / kT), radii))
