"""How far a spring swings that is followed in sub-steps."""

from mesokit.theory._check import positive


def verlet_swing(stiffness: float, substep: float, mass: float = 1.0) -> float:
    """Mean square of a harmonic mode over kT/stiffness, if velocity Verlet moves it: 1 for short
    sub-steps.

    Verlet keeps m v^2 + stiffness (1 - (w h/2)^2) x^2, w^2 = stiffness/m, and collisions see to it
    that m <v^2> = kT: so <x^2> = kT/stiffness/(1 - (w h/2)^2), exactly.

    Parameters: `stiffness` of the mode, kT/a^2; `substep` h; `mass` of its beads. Raises ValueError
    for a value not above 0, and for w h of 2 and more, where it has no end. Source: derived here;
    on what Verlet keeps, E. Hairer, C. Lubich and G. Wanner, Acta Numerica 12, 399 (2003).

    >>> round(verlet_swing(6.0, 0.05), 6)
    1.003764
    """
    positive(stiffness=stiffness, substep=substep, mass=mass)
    square = stiffness * substep**2 / (4.0 * mass)
    if square >= 1.0:
        most = 2.0 * (mass / stiffness) ** 0.5
        raise ValueError(f"substep = {substep!r}: expected less than {most:g}")
    return 1.0 / (1.0 - square)
