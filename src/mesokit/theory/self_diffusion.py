"""Self-diffusion of a fluid particle that meets again what it has set going."""

import math
from collections.abc import Sequence

import numpy as np

from mesokit.theory._check import dimension_two_or_three, positive

SMEARED = 1 / 3  # variance of each component of a distance: cells that lie anywhere around a place


def self_diffusion(
    dimension: int,
    chaos: float,
    viscosity: float,
    density: float,
    box: Sequence[float] | None = None,
    kT: float = 1.0,
    mass: float = 1.0,
) -> float:
    """Self-diffusion coefficient with the flow that a particle's own momentum sets going.

    A collision hands the momentum of a particle to its cell, where it spreads as a vortex does and
    is met again. With the modes of the box, each fading by both the viscosity and the particle's
    own motion, and with momentum given to and taken from cells that lie anywhere around it,

        D = D_chaos + (d - 1)/d kT/(rho V) sum_{k != 0} exp(-k^2 s^2/2)/((nu + D) k^2),  s^2 = 1/3.

    In an infinite 3D box the sum is kT sqrt(6/pi)/(6 pi rho (nu + D)). In 2D it grows with the
    logarithm of the box: there is no such number without one.

    Parameters:
        dimension: 2 or 3.
        chaos, viscosity: D by molecular chaos and kinematic nu, see `transport`.
        density: particles per cell.
        box: its sides in cells (periodic), None for an infinite one (3D only).
        kT, mass: thermal energy and particle mass.

    Raises ValueError for a value out of range.

    Source: derived in docs/theory.md, as `kirkwood_in_cells` for one bead of the fluid itself.
    Valid with the full grid shift and mean free paths of 0.1 to 0.5 cells: in 3D within 2 % for srd
    and at, 1 to 12 % low for the rules +a; in 2D within 6 % once momentum has crossed the box
    (measured, docs/theory.md).

    >>> round(self_diffusion(3, 0.0514, 0.8705, 10), 5)
    0.05929
    >>> [round(self_diffusion(3, 0.0514, 0.8705, 10, [L] * 3), 5) for L in (10, 20, 32)]
    [0.05769, 0.05848, 0.05878]
    """
    dimension_two_or_three(dimension)
    positive(chaos=chaos, viscosity=viscosity, density=density, kT=kT, mass=mass)
    if box is None and dimension == 2:
        raise ValueError("box = None: expected the sides of the box, in 2D there is no limit")
    if box is not None and len(box) != dimension:
        raise ValueError(f"box = {box!r}: expected {dimension} sides")
    sides = None if box is None else tuple(float(side) for side in box)
    if sides is not None:
        positive(**{f"box[{axis}]": side for axis, side in enumerate(sides)})
    noise = (dimension - 1) / dimension * kT / (density * mass)
    infinite = math.sqrt(math.pi / (2 * SMEARED)) / (2 * math.pi**2)  # the sum over the volume
    modes = noise * (infinite if sides is None else _modes(sides))
    spreading = viscosity + chaos  # nu + D of D (nu + D) = D_chaos (nu + D) + modes
    both = (spreading + math.sqrt(spreading**2 + 4 * modes)) / 2
    return both - viscosity


def _modes(sides: tuple[float, ...]) -> float:
    """Sum of exp(-k^2 s^2/2)/k^2 over the modes of a periodic box, over its volume.

    As an integral over the time t of exp(-k^2 t) from s^2/2 on, in which sums over the axes
    factorise; beyond the last t only the longest waves are left.
    """
    longest = max(sides) ** 2 / (4 * math.pi**2)
    first = SMEARED / 2
    last = first + 60 * longest
    nodes, weights = np.polynomial.legendre.leggauss(400)
    grow = math.log(last / first)
    t = first * np.exp((nodes + 1) / 2 * grow)
    every = np.ones_like(t)
    for side in sides:
        n = np.arange(1, int(side * math.sqrt(40 / first) / (2 * math.pi)) + 2)
        waves = np.exp(-np.multiply.outer(t, (2 * math.pi * n / side) ** 2))
        every = every * (1 + 2 * waves.sum(axis=1))
    volume = math.prod(sides)
    return float(((every - 1) * t * weights).sum() * grow / 2 / volume)
