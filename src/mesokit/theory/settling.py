"""Settling of many spheres, and how far they spread above the bottom."""

from mesokit.theory._check import not_negative, positive, whole

DILUTE = 6.55  # of Batchelor
FEW = 1.7601  # of Hasimoto's series


def dilute_settling(fraction: float) -> float:
    """Settling speed over that of one sphere alone, 1 - 6.55 phi.

    Parameters: `fraction` phi of the volume that is sphere. Raises ValueError for phi below 0.
    Source: G. K. Batchelor, J. Fluid Mech. 52, 245 (1972). Valid for hard spheres anywhere without
    overlap, phi below about 0.03, in the frame where the volume flux is zero.

    >>> round(dilute_settling(0.02), 3)
    0.869
    """
    not_negative(fraction=fraction)
    return 1 - DILUTE * fraction


def hindered_settling(fraction: float, exponent: float = 5.0) -> float:
    """Settling speed over that of one sphere alone, (1 - phi)^n.

    Parameters: `fraction` phi of the volume that is sphere; `exponent` n, 4.65 in the fit, 4.5 to
    5.5 in others. Raises ValueError for phi out of 0 to 1. Source: J. F. Richardson and W. N. Zaki,
    Trans. Inst. Chem. Eng. 32, 35 (1954). Valid for phi of 0.05 to 0.5 without inertia.

    >>> round(hindered_settling(0.2), 4)
    0.3277
    """
    not_negative(fraction=fraction)
    if fraction > 1:
        raise ValueError(f"fraction = {fraction!r}: expected at most 1")
    return float((1 - fraction) ** exponent)


def settling_of_few(fraction: float, number: int, viscosity: float = 1.0) -> float:
    """What N spheres in a periodic cube lack of the speed of many, over that of one alone.

    1.76 S(0) (phi/N)^(1/3)/eta, with S(0) = (1 - phi)^4/((1 + 2 phi)^2 + phi^3 (phi - 4)) of hard
    spheres (Carnahan and Starling). Add it to what was measured.

    Parameters: `fraction` phi of the volume that is sphere; `number` N; `viscosity` eta of the
    suspension over that of the fluid. Raises ValueError for a value out of range. Source: A. J. C.
    Ladd, J. Chem. Phys. 93, 3484 (1990). Of one sphere this is the first term of Hasimoto.

    >>> round(settling_of_few(0.1, 64, viscosity=1.32), 4)
    0.0707
    """
    not_negative(fraction=fraction)
    whole(1, number=number)
    positive(viscosity=viscosity)
    if fraction > 0.5:
        raise ValueError(f"fraction = {fraction!r}: expected at most 0.5, of a fluid of spheres")
    x = fraction
    structure = (1 - x) ** 4 / ((1 + 2 * x) ** 2 + x**3 * (x - 4))
    return FEW * structure * (x / number) ** (1 / 3) / viscosity
