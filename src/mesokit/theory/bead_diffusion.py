"""Diffusion of a heavy bead that collides with a fluid without memory, among other beads."""

import math

import numpy as np

from mesokit.theory._check import dimension_two_or_three, one_of, positive

POINTS = 24  # of Gauss and Legendre along each axis: the integrand is smooth


def bead_diffusion(
    rule: str,
    dimension: int,
    density: float,
    timestep: float,
    angle: float | None,
    mass: float,
    kT: float = 1.0,
    solvent_mass: float = 1.0,
    *others: tuple[float, float],
) -> float:
    """Diffusion coefficient of a bead where nothing that it gives the fluid comes back.

    A collision takes the share gamma of the velocity of a bead alone: the mean of M'/(M + M') over
    the mass M' of the fluid in its cell, a Poisson number of particles, times turned =
    (2/d)(1 - cos angle) for SRD and 1 for AT. Then D = (kT dt/M)(1/gamma - 1/2).

    With another bead of mass M2 in its cell it loses more, and finds some of it again in what that
    bead hands back. At a separation r two beads share the cell with the probability
    f = (1 - |x|)(1 - |y|).., and then the mean velocities v after the collision are
    (1 - turned) v + turned (M v + M2 v2) <1/(M + M2 + M')>. The sum over all collisions gives D of
    the pair; each kind of other beads adds the friction that follows from its mean over r.

    Parameters: `rule` "srd" or "at"; `dimension` 2 or 3; `density`, fluid particles per cell;
    `timestep`; `angle` in degrees (SRD); `mass` M of the bead; `kT`; `solvent_mass`; `others`,
    (beads per cell, their mass) of each kind of other beads, which lie anywhere. Raises
    ValueError for a value out of range. Source: M. Ripoll, K. Mussawisade, R. G. Winkler and
    G. Gompper, Phys. Rev. E 72, 016701 (2005), with the number of particles not averaged before;
    among other beads derived in docs/theory.md. Valid for random-solvent MPCD, and for short times
    in a fluid; with others that fly less than a cell until they have forgotten their velocity, and
    for few of them: three in a cell take another tenth to a third of what pairs take.

    >>> round(bead_diffusion("srd", 3, density=10, timestep=0.1, angle=130, mass=10), 6)
    0.013741
    >>> round(bead_diffusion("srd", 2, 10, 0.1, 130, 10, 1.0, 1.0, (0.15, 10.0)), 6)
    0.007184
    """
    dimension_two_or_three(dimension)
    one_of(("srd", "at"), rule=rule)
    positive(density=density, timestep=timestep, mass=mass, kT=kT, solvent_mass=solvent_mass)
    turned = 1.0
    if rule == "srd":
        if angle is None:
            raise ValueError("angle: missing; srd needs one")
        turned = 2.0 / dimension * (1.0 - math.cos(math.radians(angle)))
    inverse = _inverse_mass(mass, density, solvent_mass)
    steps = 1.0 / (turned * (1.0 - mass * inverse))  # until the velocity is forgotten
    unit = kT * timestep / mass
    free, friction = unit * (steps - 0.5), 0.0
    for crowd, other in others:
        positive(crowd=crowd, other=other)
        lone = turned * (1.0 - other * _inverse_mass(other, density, solvent_mass))
        both = turned * _inverse_mass(mass + other, density, solvent_mass)
        met = _together((1.0 / steps, lone), turned, (mass * both, other * both), dimension)
        friction -= crowd * unit * met / free**2
    return 1.0 / (1.0 / free + friction)


def _inverse_mass(mass: float, density: float, solvent_mass: float) -> float:
    """Mean of 1/(mass + M') over Poisson numbers: the integral of <exp(-(mass + M') x)> over x."""
    from scipy.integrate import quad

    scale, empty = mass + density * solvent_mass, math.exp(-density)

    def mean(x: float) -> float:
        with_some = math.exp(density * math.expm1(-solvent_mass * x / scale)) - empty
        return math.exp(-mass * x / scale) * with_some

    return empty / mass + float(quad(mean, 0.0, math.inf, epsabs=1e-11)[0]) / scale


def _together(
    lost: tuple[float, float], turned: float, kept: tuple[float, float], dimension: int
) -> float:
    """Number of steps by which another bead prolongs the memory of a velocity, integrated over
    where that is (in cells).

    `lost`: shares of the velocities of the two that a collision takes apart; `kept`: shares of them
    in the mean velocity of a cell with both, times `turned`.
    """
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    near, volume = np.ones(1), np.ones(1)
    for _ in range(dimension):
        near = np.multiply.outer(near, (1 - nodes) / 2).ravel()  # 1 - |x|, from 0 to 1
        volume = np.multiply.outer(volume, weights).ravel()
    # 1 - matrix of a collision: its inverse sums over all collisions
    own, other = (
        (1 - near) * alone + near * (turned - share)
        for alone, share in zip(lost, kept, strict=True)
    )
    handed = near**2 * kept[0] * kept[1]
    steps = other / (own * other - handed)
    return float(volume @ (steps - 1 / lost[0]))
