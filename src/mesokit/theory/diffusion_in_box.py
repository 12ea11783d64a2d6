"""Diffusion in a periodic box, where a particle feels its own images."""

import math

from mesokit.theory._check import positive

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
