"""Viscosity of dumbbells of any spring in steady shear flow."""

from mesokit.theory._check import dimension_two_or_three, not_negative, positive
from mesokit.theory._stiffening import stiffening


def dumbbell_viscosity(
    molecules: float, friction: float, square_across: float, viscosity: float = 0.0
) -> float:
    """Dynamic viscosity eta + phi zeta <y^2>/4 of a fluid with dumbbells, at any shear rate.

    y is the bond's component along the gradient. Where the spring is finitely extensible, flow
    makes <y^2> smaller: shear thinning. At rest <y^2> = <r^2>/d, which gives the viscosity at zero
    shear rate; for Hookean springs it is phi kT times the stress time, at any rate.

    Parameters: `molecules` phi, dumbbells a volume; `friction` zeta of a bead; `square_across`
    <y^2>; `viscosity` eta, dynamic, of the fluid without bonds. Raises ValueError for a value out
    of range. Source: H. Giesekus, Rheol. Acta 2, 50 (1962); R. B. Bird, C. F. Curtiss,
    R. C. Armstrong and O. Hassager, Dynamics of Polymeric Liquids 2 (1987), chapter 13. Valid for
    central springs, beads without inertia and without hydrodynamic interaction (see
    `pair_friction`).

    >>> dumbbell_viscosity(5, friction=18, square_across=3, viscosity=8.7)
    76.2
    """
    positive(molecules=molecules, friction=friction, square_across=square_across)
    not_negative(viscosity=viscosity)
    return viscosity + molecules * friction * square_across / 4


def pair_friction(friction: float, hydrodynamic_radius: float, inverse_distance: float) -> float:
    """Friction of a bead of a pair against the other bead: zeta/(1 - R_H <1/r>).

    The beads drag each other along, so that their difference moves less easily. Oseen's tensor,
    averaged over directions and over the distance r at rest.

    Parameters: `friction` zeta of a bead alone; `hydrodynamic_radius` R_H, zeta/(6 pi eta);
    `inverse_distance` <1/r>, sqrt(6/pi) over the root-mean-square length of a Gaussian bond in 3D.
    Raises ValueError for a value out of range and for R_H <1/r> of 1 or more. Source: B. H. Zimm,
    J. Chem. Phys. 24, 269 (1956), of two beads: the time of `zimm_times`.

    >>> round(pair_friction(17.0, 0.104, 0.4606), 3)
    17.855
    """
    positive(friction=friction)
    not_negative(hydrodynamic_radius=hydrodynamic_radius, inverse_distance=inverse_distance)
    share = hydrodynamic_radius * inverse_distance
    if share >= 1:
        raise ValueError(
            f"hydrodynamic_radius = {hydrodynamic_radius!r}: expected less than 1/inverse_distance"
            f" = {1 / inverse_distance:.6g}"
        )
    return friction / (1 - share)


def fene_p_thinning(
    shear_rate: float, stress_time: float, extensibility: float, dimension: int = 3
) -> float:
    """Viscosity of FENE-P dumbbells over that at zero shear rate: how they thin.

    The spring k/(1 - r^2/R0^2) of FENE dumbbells with r^2 replaced by its mean: k Z, with
    b (1 - 1/Z) = d/Z + 2 (rate tau)^2/Z^3, b = k R0^2/kT. The viscosity goes as 1/Z, at large rates
    as rate^(-2/3).

    Parameters: `shear_rate` of either sign; `stress_time` tau = zeta/4k, of the spring where it is
    short; `extensibility` b; `dimension`. Raises ValueError for a value out of range. Source:
    R. B. Bird, P. J. Dotson and N. L. Johnson, J. Non-Newtonian Fluid Mech. 7, 213 (1980). Valid as
    `dumbbell_viscosity`; FENE dumbbells themselves have other numbers (at zero shear rate
    (b + 3)/(b + 5) times the viscosity in 3D) and thin alike.

    >>> [round(fene_p_thinning(rate, 10, 12), 4) for rate in (0, 0.1, 1)]
    [1.0, 0.9311, 0.4104]
    """
    positive(stress_time=stress_time, extensibility=extensibility)
    dimension_two_or_three(dimension)
    at_rest = 1 + dimension / extensibility  # Z
    drive = 2 * (shear_rate * stress_time) ** 2 / extensibility
    return 1 / stiffening(drive / at_rest**3)
