"""Bond length of linear trimers in shear flow, with hydrodynamic interaction."""

import math

from mesokit.theory._check import not_negative, positive
from mesokit.theory._stiffening import stiffening

# smallest l/R_H; below, A < (sqrt 17 - 1)/sqrt 8 B, and the mobility matrix is not positive
SHORTEST = (math.sqrt(17) - 1) / math.sqrt(8) * math.sqrt(6 / math.pi)


def trimer_spring_constant(
    bond_length: float,
    shear_rate: float,
    viscosity: float,
    hydrodynamic_radius: float,
    kT: float = 1.0,
) -> float:
    """Spring constant K that gives a trimer of bonds U = K r^2 its bond length in shear flow.

    The positive root of l^2 K^3 - (3/2) kT K^2 - (kT rate^2/4) Q(l) = 0 with the mobilities
    A = 1/(6 pi eta R_H) of a bead and B = 1/(eta l sqrt(6 pi^3)) of its neighbour, and

        Q = (a^2 + b^2)/(a^2 - b^2)^2,  a = 4 (B - A),  b = 2 A - (4 - sqrt 2) B.

    At rest 3 kT/(2 l^2); at large rates it goes as rate^(2/3).

    Parameters:
        bond_length: root-mean-square length l of a bond.
        shear_rate: of either sign.
        viscosity: eta, dynamic, of the fluid.
        hydrodynamic_radius: R_H of a bead, kT/(6 pi eta D) of a free one.
        kT: thermal energy.

    Raises ValueError for a value out of range, l below 1.526 R_H among them. Source: D. Toneian,
    diploma thesis, TU Wien (2015), eq. (6.41), brought to this form in docs/theory-polymers.md.
    Valid for A > 1.1042 B, that is l > 1.526 R_H (the thesis' A > B does not suffice), pre-averaged
    hydrodynamic interaction, overdamped beads, 3D.

    >>> [round(trimer_spring_constant(2, g, 8.7, 0.3), 6) for g in (0, 0.1, 10)]
    [0.375, 0.816861, 14.465371]
    """
    positive(hydrodynamic_radius=hydrodynamic_radius, viscosity=viscosity, kT=kT)
    if not (math.isfinite(bond_length) and bond_length > SHORTEST * hydrodynamic_radius):
        raise ValueError(
            f"bond_length = {bond_length!r}: expected more than 1.526 hydrodynamic_radius = "
            f"{SHORTEST * hydrodynamic_radius:.6g}, below which the mobility is not positive"
        )
    at_rest = 3 * kT / (2 * bond_length**2)
    stretch = _stretch(bond_length, viscosity, hydrodynamic_radius)
    return at_rest * stiffening(shear_rate**2 * stretch / (6 * at_rest**2))


def trimer_bond_length(
    spring_constant: float,
    shear_rate: float,
    viscosity: float,
    hydrodynamic_radius: float,
    kT: float = 1.0,
) -> float:
    """Root-mean-square bond length l of a trimer of bonds U = K r^2 in shear flow.

    l^2 = kT/2K [3 + rate^2/(2 K^2) Q(l)], with l in Q as well; sqrt(3 kT/2K) at rest, and
    6 pi eta R_H rate sqrt(5 kT/(144 K^3)) at large rates.

    Parameters: `spring_constant` K, the others, source and range as in `trimer_spring_constant`.
    Raises ValueError for a value out of range, and where no bond length of 1.526 R_H or more solves
    it (a spring too stiff for the hydrodynamic radius).

    >>> [round(trimer_bond_length(1, g, 8.7, 0.3), 6) for g in (0, 0.1, 1)]
    [1.224745, 1.665299, 9.553401]
    """
    positive(spring_constant=spring_constant, viscosity=viscosity)
    positive(hydrodynamic_radius=hydrodynamic_radius, kT=kT)
    not_negative(shear_rate=abs(shear_rate))

    def excess(length: float) -> float:
        q = _stretch(length, viscosity, hydrodynamic_radius)
        drive = shear_rate**2 * q / (2 * spring_constant**2)
        return length**2 - kT / (2 * spring_constant) * (3 + drive)

    shortest = SHORTEST * hydrodynamic_radius
    if excess(shortest) >= 0:
        raise ValueError(
            f"spring_constant = {spring_constant!r}: bonds would be shorter than "
            f"1.526 hydrodynamic_radius = {shortest:.6g}, below which the mobility is not positive"
        )
    from scipy.optimize import brentq

    longest = 2 * shortest
    while excess(longest) < 0:
        longest *= 2
    return float(brentq(excess, shortest, longest, xtol=1e-14, rtol=1e-14))


def _stretch(length: float, viscosity: float, radius: float) -> float:
    """Q, the effect of the square of the shear rate; it falls with the bond length."""
    own = 1 / (6 * math.pi * viscosity * radius)
    other = 1 / (viscosity * length * math.sqrt(6 * math.pi**3))
    a, b = 4 * (other - own), 2 * own - (4 - math.sqrt(2)) * other
    return (a * a + b * b) / (a * a - b * b) ** 2
