"""When two species demix under the rule that turns the flux of colour up its gradient."""

import math

from mesokit.theory._check import dimension_two_or_three, positive


def demixing_diffusion(
    dimension: int,
    density: float,
    timestep: float,
    coupling: float,
    kT: float = 1.0,
    mass: float = 1.0,
) -> float:
    """Diffusion coefficient of long waves of colour in a mixture in equal parts.

    A collision leaves a cell of n particles with the flux of colour
    coupling (n - 1) sqrt(kT/m) grad C, and 1/n of the one that it had; streaming takes
    kT/m timestep grad C from it. In the mean over a step

        D = kT/m timestep (n + 1)/(2 (n - 1)) - coupling n sqrt(kT/m).

    Where it is negative waves of colour grow: the fluid demixes.

    Parameters:
        dimension: 2 or 3, in which it is the same.
        density: particles per cell n, of both species together; numbers of all cells alike.
        timestep: time between collisions.
        coupling: that of rule 'demix', in a.
        kT, mass: thermal energy and particle mass.

    Raises ValueError for a value out of range.

    Source: derived in docs/theory.md. For weak couplings, at which rotations are nearly uniform.

    >>> round(demixing_diffusion(2, 10, 0.1, 0.0), 5)
    0.06111
    >>> round(demixing_diffusion(2, 10, 0.1, 0.05), 5)
    -0.43889
    """
    dimension_two_or_three(dimension)
    positive(timestep=timestep, kT=kT, mass=mass)
    if not density > 1:
        raise ValueError(f"density = {density!r}: expected more than 1")
    if not 0 <= coupling < math.inf:
        raise ValueError(f"coupling = {coupling!r}: expected a number of at least 0")
    free = kT / mass * timestep * (density + 1) / (2 * (density - 1))
    return free - coupling * density * math.sqrt(kT / mass)


def demixing_coupling(
    dimension: int, density: float, timestep: float, kT: float = 1.0, mass: float = 1.0
) -> float:
    """The coupling above which a mixture in equal parts demixes, by molecular chaos.

    Parameters:
        dimension, density, timestep, kT, mass: as for `demixing_diffusion`, whose zero it is.

    Raises ValueError for a value out of range.

    >>> round(demixing_coupling(2, 10, 0.1), 6)
    0.006111
    """
    free = demixing_diffusion(dimension, density, timestep, 0.0, kT, mass)
    return free / (density * math.sqrt(kT / mass))
