"""Transport coefficients of MPCD fluids: viscosity, diffusion, sound, heat."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.theory._check import dimension_two_or_three, one_of, positive
from mesokit.theory.srd_angular_table import cell_table, rigid_share

Array = NDArray[np.float64]
Rule = Literal["srd", "srd+a", "at", "at+a"]
Angle = float | Literal["uniform"] | None
Thermostat = Literal["none", "maxwell-boltzmann", "rescale"]
ROUNDING = 1e-13  # least loss in a collision that is more than a rounding error


@dataclass(frozen=True)
class Transport:
    """Transport coefficients in units of the cell side a = 1.

    Viscosities are kinematic, a^2/time, except `dynamic_viscosity` = density * mass * viscosity.
    `diffusion` is that of one fluid particle. `sound_attenuation` Gamma damps a sound wave by
    exp(-Gamma k^2 t / 2). None marks a coefficient that does not exist (heat does not diffuse
    where the collision does not conserve energy) or has no known formula (SRD+a).
    """

    viscosity_kinetic: float
    viscosity_collisional: float
    viscosity: float
    dynamic_viscosity: float
    diffusion: float
    schmidt: float
    sound_speed: float
    thermal_diffusivity: float | None
    sound_attenuation: float | None
    mean_free_path: float


def transport(
    rule: Rule,
    dimension: int,
    density: float,
    timestep: float,
    angle: Angle = None,
    kT: float = 1.0,
    mass: float = 1.0,
    thermostat: Thermostat = "none",
) -> Transport:
    """Transport coefficients of an MPCD fluid at molecular chaos, with exact Poisson occupancy.

    Parameters:
        rule: "srd" (rotation), "at" (Andersen); "+a" conserves angular momentum.
        dimension: 2 or 3.
        density: mean number of particles per cell, M.
        timestep: time between two collisions.
        angle: rotation angle in degrees, SRD only. In 2D its sign is random, in 3D its axis; in 2D
            "uniform" draws it from [0, 360).
        kT, mass: thermal energy and particle mass.
        thermostat: "none"; "maxwell-boltzmann", which gives each cell a fresh relative kinetic
            energy each step; "rescale", which sets that energy to its mean.

    Raises ValueError for a value out of range and for an angle that the rule does not take.

    Source: Gompper, Ihle, Kroll and Winkler (2009), Table 1, for SRD; Noguchi and Gompper (2008)
    for the limits of large M of AT; the sums over occupancies, the +a rules at finite M, the
    thermostatted rules and the attenuation of isothermal sound were derived in docs/theory. A
    collision of N particles multiplies a velocity by 1 - gD(N), the shear stress by 1 - gS(N) and
    moves momentum q(N) across the cell; gD and gS are means over the cells that a particle sees,
    N P(N)/M, and
        nu = kT dt/m (1/gS - 1/2) + <q>/(M dt),   D = kT dt/m (1/gD - 1/2).

    Valid for M of at least about 3 and a grid shift. Correlated collisions (mean free path below
    about 0.2) raise D by some 15 % and change nu by 1 to 2 %; fluctuations raise nu further,
    mostly in 2D (`viscosity_renormalised`). With a thermostat D and nu_kin are a one-step estimate,
    1 to 13 % low where velocities outlast the collision (SRD with small angles, few particles).

    >>> t = transport("srd", dimension=3, density=10, timestep=0.1, angle=130)
    >>> round(t.viscosity, 4), round(t.diffusion, 4), round(t.schmidt, 2)
    (0.87, 0.0515, 16.91)
    """
    _check(rule, dimension, density, timestep, angle, kT, mass, thermostat)
    n, p = _poisson(density)
    seen = n * p / density  # occupancy of the cell of a tagged particle
    r1, r2, cosine = _rotation(dimension, fixed_angle(angle))
    angular = rule.endswith("+a")
    if angular:
        rigid = rigid_share(dimension, n)
        kept, shear, along = cell_table(dimension, n)
    else:
        rigid = kept = 1 / n
        shear = along = (n - 1) / 12
    isothermal = rule.startswith("at") or thermostat != "none"
    s1, s2 = _thermostat(thermostat, np.rint(dimension * n * (1 - rigid)))

    def time(one_minus_g: Array) -> float:
        """Decorrelation time dt (1/g - 1/2) of the discrete-time Green-Kubo sum, times kT/m.

        An empty neighbourhood (N = 0) cannot hold the tagged particle, so the weights sum to 1.
        """
        forgotten = float(np.sum(seen * (1 - one_minus_g)))
        if fixed_angle(angle) is not None and forgotten < ROUNDING:
            raise ValueError(f"angle = {angle!r}: turns too little to tell the viscosity")
        if forgotten == 0:
            raise ValueError(f"density = {density!r}: too few particles ever meet")
        return kT / mass * timestep * (1 / forgotten - 0.5)

    def moved(q: Array) -> float:
        return float(np.sum(p * (1 - r1 * s1) * q)) / (density * timestep)

    kinetic = time(kept + 2 * r1 * s1 * (rigid - kept) + r2 * s2 * (1 - 2 * rigid + kept))
    collisional = moved(shear)
    viscosity = kinetic + collisional
    diffusion = time(rigid + (1 - rigid) * r1 * s1)
    heat = attenuation = None
    c2 = kT / mass
    if isothermal:
        # the trace of the stress decays with the energy that the collision destroys
        attenuation = (
            2 * (dimension - 1) / dimension * kinetic + 2 / dimension * time(rigid) + moved(along)
        )
    else:
        c2 *= (dimension + 2) / dimension
        if not angular:
            d = dimension
            heat = time(
                1 / n**2 + (1 - 1 / n) * ((1 + 2 / d + 2 * r2 * (1 - 1 / d)) / n + r1 * (1 - 2 / n))
            )
            # the integral of Gompper et al. (2009) is this Poisson sum, which cannot overflow
            heat += (
                (1 - cosine) * float(np.sum(p * (1 - 1 / n))) / (3 * (d + 2) * density * timestep)
            )
            attenuation = 2 / d * heat + 2 * (d - 1) / d * kinetic + collisional
    return Transport(
        viscosity_kinetic=kinetic,
        viscosity_collisional=collisional,
        viscosity=viscosity,
        dynamic_viscosity=density * mass * viscosity,
        diffusion=diffusion,
        schmidt=viscosity / diffusion,
        sound_speed=math.sqrt(c2),
        thermal_diffusivity=heat,
        sound_attenuation=attenuation,
        mean_free_path=timestep * math.sqrt(kT / mass),
    )


def takes_angle(rule: str) -> bool:
    """True if a rule turns velocities by an angle, which `transport` then needs.

    >>> takes_angle("srd"), takes_angle("at+a")
    (True, False)
    """
    return rule.startswith("srd")


def fixed_angle(angle: Angle) -> float | None:
    """The angle, unless there is none or it is uniform."""
    return None if isinstance(angle, str) else angle


def _check(
    rule: str,
    dimension: int,
    density: float,
    timestep: float,
    angle: Angle,
    kT: float,
    mass: float,
    thermostat: str,
) -> None:
    if rule == "none":
        raise ValueError("rule = 'none': no transport coefficients; particles never meet")
    one_of(("srd", "srd+a", "at", "at+a"), rule=rule)
    dimension_two_or_three(dimension)
    positive(density=density, timestep=timestep, kT=kT, mass=mass)
    one_of(("none", "maxwell-boltzmann", "rescale"), thermostat=thermostat)
    if isinstance(angle, str):
        one_of(("uniform",), angle=angle)
        if dimension == 3 or rule.startswith("at"):
            raise ValueError(f"angle = 'uniform': expected degrees for {rule!r} in {dimension}D")
    elif rule.startswith("at"):
        if angle is not None:
            raise ValueError(f"angle = {angle!r}: expected None for rule {rule!r}")
    elif angle is None:
        raise ValueError(f"angle = None: expected degrees for rule {rule!r}")
    elif not 0 < angle < 360 or (dimension == 2 and angle == 180):
        # a half turn in 2D leaves the stress as it was: its viscosity is infinite
        raise ValueError(
            f"angle = {angle!r}: expected degrees above 0 and below 360"
            + (", not 180" if dimension == 2 else "")
        )


def cell_memory(
    dimension: int, density: float, angle: Angle, rule: str, thermostat: str
) -> tuple[Array, Array, Array, Array]:
    """Occupancies N, their Poisson probabilities, and the shares that a cell keeps of a velocity,
    r1 s1, and of a stress about its mean velocity, r2 s2."""
    n, p = _poisson(density)
    rigid = rigid_share(dimension, n) if rule.endswith("+a") else 1 / n
    r1, r2, _ = _rotation(dimension, fixed_angle(angle))
    s1, s2 = _thermostat(thermostat, np.rint(dimension * n * (1 - rigid)))
    return n, p, r1 * s1, r2 * s2


def _poisson(density: float) -> tuple[Array, Array]:
    """Occupancies N >= 1 that matter and their Poisson probabilities."""
    from scipy.special import gammaln

    width = 12 * math.sqrt(density) + 40
    n = np.arange(max(1, int(density - width)), int(density + width) + 1, dtype=float)
    return n, np.exp(n * math.log(density) - density - gammaln(n + 1))


def _rotation(dimension: int, angle: float | None) -> tuple[float, float, float]:
    """Mean of a random rotation on vectors (r1) and traceless tensors (r2), and mean cos(angle).

    Without an angle (AT, or an angle uniform in 2D) nothing is remembered.
    """
    if angle is None:
        return 0.0, 0.0, 0.0
    one, two = math.cos(math.radians(angle)), math.cos(2 * math.radians(angle))
    return (
        (one, two, one) if dimension == 2 else ((1 + 2 * one) / 3, (1 + 2 * one + 2 * two) / 5, one)
    )


def _thermostat(thermostat: str, freedoms: Array) -> tuple[Array, Array]:
    """Share of a velocity and of a stress that is left where a cell is scaled to a new energy.

    The scaling is s^2 = E'/E with E drawn from Gamma(k = f/2) for f degrees of freedom, and E'
    likewise or k: <s E>/<E> is then c^2 or c with c = Gamma(k + 1/2)/(Gamma(k) sqrt(k)), and
    <s^2 E^2>/<E^2> = k/(k + 1). Exact for one step without angular momentum, to order 1/N with it.
    """
    from scipy.special import gammaln

    if thermostat == "none":
        return np.ones_like(freedoms), np.ones_like(freedoms)
    k = np.maximum(freedoms, 1) / 2  # a lone particle has no relative energy: any value will do
    velocity = np.exp(gammaln(k + 0.5) - gammaln(k)) / np.sqrt(k)
    return velocity**2 if thermostat == "maxwell-boltzmann" else velocity, k / (k + 1)
