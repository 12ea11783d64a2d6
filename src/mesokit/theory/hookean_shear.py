"""Rouse molecules and dumbbells in steady shear flow."""

from typing import NamedTuple

from numpy.typing import ArrayLike

from mesokit.theory._check import not_negative, positive
from mesokit.theory._stiffening import stiffening
from mesokit.theory.normal_modes import NormalModes
from mesokit.theory.relaxation_modulus import apparent_viscosity, checked_times
from mesokit.theory.rouse_times import rouse_times_from_slowest


class ShearStress(NamedTuple):
    """Steady shear: `viscosity` sigma_xy/rate and normal-stress differences
    `first` sigma_xx - sigma_yy, `second` sigma_yy - sigma_zz, tension positive."""

    viscosity: float
    first: float
    second: float


class SizeInShear(NamedTuple):
    """Mean squares of a molecule in shear: its bonds (averaged along it), end-to-end distance
    from bead 0 to the last one, and radius of gyration."""

    bond: float
    end_to_end: float
    gyration: float


def maxwell_shear(
    shear_rate: float, modulus: float, stress_times: ArrayLike, viscosity: float = 0.0
) -> ShearStress:
    """Stress of Rouse molecules in shear, an upper-convected Maxwell fluid for each mode.

    Viscosity eta + phi kT sum tau_p at any shear rate (no shear thinning), first normal-stress
    difference 2 phi kT sum (rate tau_p)^2, second 0.

    Parameters: `shear_rate` of either sign; `modulus` phi kT, phi the number of molecules a volume;
    `stress_times` tau_p, see `rouse_times`; `viscosity` eta, dynamic, of the fluid without bonds.
    Raises ValueError for a value out of range. Source: R. B. Bird, C. F. Curtiss, R. C. Armstrong
    and O. Hassager, Dynamics of Polymeric Liquids 2 (1987), chapters 13 (dumbbells) and 15
    (chains). Valid for springs without rest length, beads without hydrodynamic interaction, and
    temperatures held.

    >>> maxwell_shear(0.1, modulus=5, stress_times=[10], viscosity=8)
    ShearStress(viscosity=58.0, first=10.0, second=0.0)
    """
    tau = checked_times(modulus, stress_times, viscosity)
    first = 2 * modulus * float(((shear_rate * tau) ** 2).sum())
    return ShearStress(apparent_viscosity(viscosity, modulus, tau), first, 0.0)


def size_in_shear(
    modes: NormalModes,
    shear_rate: float,
    stress_time: float,
    bond_squared: float,
    dimension: int = 3,
) -> SizeInShear:
    """Mean square size of a Rouse molecule in shear.

    Each mode is stretched along the flow alone: <X_p^2> = <b^2>/eigenvalue_p (1 + (2/d)
    (rate tau_p)^2). So a dumbbell's <r^2> = <b^2> (1 + (2/d) (rate tau)^2).

    Parameters:
        modes: of the molecule, as `linear_modes(2)` for a dumbbell.
        shear_rate: of either sign.
        stress_time: its slowest stress time, see `rouse_times`.
        bond_squared: <b^2> of a free bond at rest, see `mean_square_bond`.
        dimension: of space.

    Raises ValueError for a value out of range. Source: Bird et al. (1987), chapter 13; for chains
    derived in docs/theory-polymers.md. Valid as `maxwell_shear`.

    >>> from mesokit.theory import linear_modes
    >>> round(size_in_shear(linear_modes(2), 0.1, 10, 9).end_to_end, 9)
    15.0
    """
    positive(stress_time=stress_time, bond_squared=bond_squared, dimension=dimension)
    tau = rouse_times_from_slowest(modes, stress_time=stress_time).stress
    stretch = bond_squared * (1 + 2 / dimension * (shear_rate * tau) ** 2)
    squares = stretch / modes.eigenvalues[1:]
    ends = modes.vectors[-1, 1:] - modes.vectors[0, 1:]
    bonds = round(float(modes.eigenvalues.sum())) / 2  # the trace counts each at both its beads
    return SizeInShear(
        float(stretch.sum()) / bonds,
        float((ends**2 * squares).sum()),
        float(squares.sum()) / len(modes.eigenvalues),
    )


def shear_heating(
    shear_rate: float,
    viscosity: float,
    density: float,
    bonds_per_particle: float = 0.0,
    dimension: int = 3,
) -> float:
    """Rate d(kT)/dt at which shear warms a fluid without a thermostat.

    2 eta rate^2/(d (n + n_b)): the work done goes into d n/2 kinetic and d n_b/2 spring degrees of
    freedom a volume.

    Parameters: `shear_rate`; `viscosity` eta, dynamic, with the molecules' share, see
    `maxwell_shear`; `density` n, particles a cell; `bonds_per_particle` n_b/n, 1/2 for dimers;
    `dimension`. Raises ValueError for a value out of range. Source: first law and equipartition.
    Valid as long as rate tau is well below 1 (beyond, stretched springs store more) and for rules
    that conserve energy. With a thermostat the temperature settles, see `shear_warming`.

    >>> round(shear_heating(0.1, viscosity=75.7, density=10, bonds_per_particle=0.5), 6)
    0.033644
    """
    positive(viscosity=viscosity, density=density, dimension=dimension)
    not_negative(bonds_per_particle=bonds_per_particle)
    return 2 * viscosity * shear_rate**2 / (dimension * density * (1 + bonds_per_particle))


def dumbbell_thinning(shear_rate: float, stress_time: float, dimension: int = 3) -> float:
    """Stress time over that at rest of dumbbells whose mean square length is held in shear.

    Springs are made stiffer with the shear rate, by the factor x with x^2 (x - 1) = (2/d)
    (rate tau_0)^2, so that <r^2> stays; the stress time is tau_0/x. Hence shear thinning, with
    viscosity eta + phi kT tau_0/x and first normal-stress difference 2 phi kT (rate tau_0/x)^2:
    at large rates they go as rate^(-2/3) and rate^(2/3).

    Parameters: `shear_rate`; `stress_time` tau_0 at rest; `dimension`. Returns 1/x. Raises
    ValueError for a value out of range. Source: B. Kowalik and R. G. Winkler, J. Chem. Phys. 138,
    104903 (2013), the scheme; the equation follows from `size_in_shear`. Valid as `maxwell_shear`.

    >>> round(dumbbell_thinning(0.1, 10), 6)
    0.735139
    """
    positive(stress_time=stress_time, dimension=dimension)
    drive = 2 / dimension * (shear_rate * stress_time) ** 2
    return 1 / stiffening(drive)
