"""Diffusion and viscosity in a periodic box, which depend on its size."""

import math

from mesokit.theory._check import dimension_two_or_three, positive


def viscosity_renormalised(
    dimension: int,
    viscosity: float,
    sound_attenuation: float,
    density: float,
    box_length: float = math.inf,
    kT: float = 1.0,
    mass: float = 1.0,
    cutoff: float = 2.0,
) -> float:
    """Kinematic viscosity in a periodic box, with one loop of fluctuations added.

    Parameters:
        dimension: 2 or 3.
        viscosity, sound_attenuation: molecular-chaos nu and Gamma, see `transport`.
        density: particles per cell.
        box_length: side of the box in cells; may be infinite in 3D only (in 2D nu diverges).
        kT, mass: thermal energy and particle mass.
        cutoff: shortest wavelength c that counts, in cells: about 2 for a mean free path much
            shorter than a cell, about 8 for one of about a cell.

    Raises ValueError for a value out of range.

    Source: Forster, Nelson and Stephen (1977) for the logarithm in 2D; the factors are derived in
    docs/theory; rho = density * mass, modes from 2 pi/L to 2 pi/c,
        2D: nu + kT/(16 pi rho) (1/nu + 1/Gamma) ln(L/c)
        3D: nu + kT/(pi^2 rho) (7/(60 nu) + 1/(30 Gamma)) (2 pi/c - 2 pi/L).
    Valid while the correction is small; the constant c is known to a factor of about 1.5. For
    2D SRD with M = 5, 90 degrees and timestep 1, simulation gave a rise from 0.19 (molecular
    chaos) to 0.207, 0.219 and 0.232 at L = 16, 32 and 64.

    >>> round(viscosity_renormalised(2, 0.1907, 0.9509, 5, box_length=64, cutoff=8), 4)
    0.2428
    >>> round(viscosity_renormalised(3, 0.4992, 0.6656, 5), 4)
    0.5173
    """
    dimension_two_or_three(dimension)
    positive(viscosity=viscosity, sound_attenuation=sound_attenuation, density=density)
    positive(kT=kT, mass=mass, cutoff=cutoff)
    if not box_length > cutoff or (dimension == 2 and math.isinf(box_length)):
        raise ValueError(
            f"box_length = {box_length!r}: expected more than cutoff = {cutoff!r}"
            + (" and finite in 2D" if dimension == 2 else "")
        )
    noise = kT / (density * mass)
    if dimension == 2:
        modes = math.log(box_length / cutoff) / (16 * math.pi)
        return viscosity + noise * modes * (1 / viscosity + 1 / sound_attenuation)
    modes = 2 * math.pi * (1 / cutoff - 1 / box_length) / math.pi**2
    return viscosity + noise * modes * (7 / (60 * viscosity) + 1 / (30 * sound_attenuation))


CUBIC = 2.837297  # of a simple cubic lattice of charges in a uniform background


def diffusion_in_box(
    diffusion: float, box_length: float, viscosity: float, kT: float = 1.0
) -> float:
    """Diffusion coefficient D - 2.837297 kT/(6 pi eta L) in a cubic periodic box.

    Parameters: `diffusion` D in an infinite fluid; `box_length` L; `viscosity` eta, dynamic; `kT`.
    To correct a measured value add the difference. Raises ValueError for a value not above 0.
    Source: B. Dunweg and K. Kremer, J. Chem. Phys. 99, 6983 (1993); I.-C. Yeh and G. Hummer, J.
    Phys. Chem. B 108, 15873 (2004). Valid in 3D for particles and molecules much smaller than the
    box (next order: (R/L)^3); of hydrodynamic diffusion only, so that it is an upper bound for
    fluid particles.

    >>> round(diffusion_in_box(0.0587, 20, viscosity=8.7), 6)
    0.057835
    """
    positive(diffusion=diffusion, box_length=box_length, viscosity=viscosity, kT=kT)
    return diffusion - CUBIC * kT / (6 * math.pi * viscosity * box_length)
