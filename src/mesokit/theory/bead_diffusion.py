"""Diffusion of a heavy bead that collides with a fluid that forgets."""

from __future__ import annotations

import math

import numpy as np

from mesokit.theory._check import dimension_two_or_three, one_of, positive


def bead_diffusion(
    rule: str,
    dimension: int,
    density: float,
    timestep: float,
    angle: float | None,
    mass: float,
    kT: float = 1.0,
    solvent_mass: float = 1.0,
) -> float:
    """Diffusion coefficient of a bead alone, where nothing that it gives the fluid comes back.

    A collision takes the share gamma of its velocity: the mean of M'/(M + M') over the mass M' of
    the fluid in its cell, a Poisson number of particles, times (2/d)(1 - cos angle) for SRD and 1
    for AT. Then D = (kT dt/M)(1/gamma - 1/2).

    Parameters: `rule` "srd" or "at"; `dimension` 2 or 3; `density`, fluid particles per cell;
    `timestep`; `angle` in degrees (SRD); `mass` M of the bead; `kT`; `solvent_mass`. Raises
    ValueError for a value out of range. Source: M. Ripoll, K. Mussawisade, R. G. Winkler and
    G. Gompper, Phys. Rev. E 72, 016701 (2005), with the number of particles not averaged before.
    Valid for random-solvent MPCD, and for short times in a fluid.

    >>> round(bead_diffusion("srd", 3, density=10, timestep=0.1, angle=130, mass=10), 6)
    0.013741
    """
    dimension_two_or_three(dimension)
    one_of(("srd", "at"), rule=rule)
    positive(density=density, timestep=timestep, mass=mass, kT=kT, solvent_mass=solvent_mass)
    turned = 1.0
    if rule == "srd":
        if angle is None:
            raise ValueError("angle: missing; srd needs one")
        turned = 2.0 / dimension * (1.0 - math.cos(math.radians(angle)))
    number = np.arange(int(density + 12.0 * math.sqrt(density) + 30.0))
    log_factorial = np.concatenate([[0.0], np.cumsum(np.log(number[1:]))])
    chance = np.exp(number * math.log(density) - density - log_factorial)
    fluid = number * solvent_mass
    gamma = turned * float((chance * fluid / (mass + fluid)).sum())
    return kT * timestep / mass * (1.0 / gamma - 0.5)
