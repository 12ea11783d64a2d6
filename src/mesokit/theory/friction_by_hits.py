"""How fast a body in a gas forgets its velocity, before the fluid gives anything back."""

import math

from mesokit.theory._check import dimension_two_or_three, positive

# of the distance of two points of a cell across a plane: half its mean over all planes
CUT = {2: 0.521405433164721 / math.pi, 3: 0.661707182267176 / 4}


def enskog_friction(
    radius: float,
    density: float,
    mass: float,
    dimension: int = 3,
    kT: float = 1.0,
    solvent_mass: float = 1.0,
    inertia: float | None = None,
) -> float:
    """Friction of a sphere or disk by the hits of an ideal gas without memory.

    Smooth, (8/3) sqrt(2 pi kT mu) n R^2 in 3D and 2 sqrt(2 pi kT mu) n R in 2D, with mu the reduced
    mass. Where a hit turns the whole relative velocity of the surface back, times
    (1 + 2 chi)/(1 + chi) in 3D and 1 + chi/(2 + 2 chi) in 2D, chi = I/(mu R^2): 2 and 3/2 of a
    heavy body.

    Parameters: `radius` R; `density`, particles per cell; `mass` of the sphere; `dimension` 2 or
    3; `kT`; `solvent_mass`; `inertia` I of a body without slip, infinite if it cannot turn (none:
    smooth). Raises ValueError for a value out of range. Source: J. T. Hynes, Annu. Rev. Phys. Chem.
    28, 301 (1977); in 2D from the same pressure 4 n sqrt(m kT/2 pi) u on a surface that moves at u
    along its normal, and half of it for u along the surface. Valid at times too short for the fluid
    to give anything back. The factor 2/5 of other papers is for equal rough spheres.

    >>> round(enskog_friction(3.0, density=10, mass=1130), 1)
    601.3
    >>> round(enskog_friction(3.0, density=10, mass=1130, inertia=0.4 * 1130 * 9), 1)
    1201.3
    """
    dimension_two_or_three(dimension)
    positive(radius=radius, density=density, mass=mass, kT=kT, solvent_mass=solvent_mass)
    reduced = mass * solvent_mass / (mass + solvent_mass)
    rough = _turning_share(reduced * radius**2, inertia) * (dimension - 1) / 2
    thermal = math.sqrt(2.0 * math.pi * kT * reduced)
    if dimension == 2:
        return 2.0 * thermal * density * radius * (1 + rough)
    return 8.0 / 3.0 * thermal * density * radius**2 * (1 + rough)


def enskog_rotational_friction(
    radius: float,
    density: float,
    mass: float,
    inertia: float,
    dimension: int = 3,
    kT: float = 1.0,
    solvent_mass: float = 1.0,
) -> float:
    """Friction of the angular velocity by hits that turn the relative velocity of the surface back.

    (8/3) sqrt(2 pi kT mu) n R^4 chi/(1 + chi) in 3D, 2 sqrt(2 pi kT mu) n R^3 chi/(1 + chi) in 2D.

    Parameters, errors and meaning of chi and mu as in `enskog_friction`; `inertia` I. Source:
    derived here from the same impulses, 2 mu chi/(1 + chi) times the relative velocity along the
    surface. Valid at times too short for the fluid to give anything back.

    >>> round(enskog_rotational_friction(3.0, density=10, mass=1130, inertia=0.4 * 1130 * 9), 1)
    5400.0
    """
    smooth = enskog_friction(radius, density, mass, dimension, kT, solvent_mass)
    reduced = mass * solvent_mass / (mass + solvent_mass)
    return smooth * radius**2 * _turning_share(reduced * radius**2, inertia)


def friction_by_virtual_particles(
    surface: float,
    density: float,
    timestep: float,
    dimension: int = 3,
    angle: float | None = None,
    mass: float = 1.0,
) -> float:
    """Friction by collisions with the virtual particles of a body, w (1 - r1)(n - 1 + e^-n) m S/dt.

    Virtual particles and fluid share the cells that the surface cuts. A collision takes the share
    1 - r1 of their relative velocity, and w is the mean of f(1 - f) over the part f of a cell that
    is fluid, times the depth of such cells: 0.1654 in 3D, 0.1660 in 2D.

    Parameters: `surface` S of the body (its perimeter in 2D); `density` n, particles per cell;
    `timestep`; `dimension` 2 or 3; `angle` of the collision in degrees (none: Andersen's, r1 = 0);
    `mass` of a particle. Raises ValueError for a value out of range. Source: derived in
    docs/theory.md, for bodies of more than a few cells and rules without angular momentum. Valid
    for one timestep, beside the friction by hits.

    >>> round(friction_by_virtual_particles(4 * math.pi * 9, 10, 0.1, 3, angle=130), 1)
    1844.1
    """
    dimension_two_or_three(dimension)
    positive(surface=surface, density=density, timestep=timestep, mass=mass)
    lost = 1.0
    if angle is not None:
        lost = 2 / dimension * (1 - math.cos(math.radians(angle)))
    met = density + math.expm1(-density)
    return CUT[dimension] * lost * met * mass * surface / timestep


def velocity_variance(mass: float, total_mass: float = math.inf, kT: float = 1.0) -> float:
    """Mean square kT/M (1 - M/M_all) of one component of the velocity of a body.

    In a periodic box the total momentum is zero, which takes the last part. Angular momentum is not
    conserved there: for the angular velocity give the moment of inertia, without `total_mass`.

    Parameters: `mass` M; `total_mass` of fluid and bodies; `kT`. Raises ValueError for a value out
    of range. Source: equipartition.

    >>> round(velocity_variance(100.0, total_mass=1000.0), 4)
    0.009
    """
    positive(mass=mass, kT=kT)
    if not total_mass >= mass:
        raise ValueError(f"total_mass = {total_mass!r}: expected at least mass = {mass!r}")
    return kT * (1 / mass - 1 / total_mass)


def _turning_share(reduced: float, inertia: float | None) -> float:
    """chi/(1 + chi), 0 for a smooth body."""
    if inertia is None:
        return 0.0
    if not inertia > 0:
        raise ValueError(f"inertia = {inertia!r}: expected above 0")
    return 1 / (1 + reduced / inertia)
