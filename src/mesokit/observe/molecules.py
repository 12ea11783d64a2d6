"""What observables of molecules share: who belongs to which, and the modes of their springs."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.errors import CaseError
from mesokit.observe import setting
from mesokit.observe.mean_square_displacement import spread_ids
from mesokit.observe.result import Array

if TYPE_CHECKING:
    from mesokit.case import Case
    from mesokit.mpcd.molecule import Molecule


def molecule_of(case: Case, quantity: str = "this") -> Molecule:
    """What the fluid is made of. Raises CaseError for a fluid of single particles."""
    if case.fluid.molecule is None:
        raise CaseError(f"{quantity} needs a fluid of molecules; give fluid.molecule")
    return case.fluid.molecule


def beads_of(case: Case, wanted: int | None = None) -> NDArray[np.int64]:
    """Ids of the beads (molecules, length) of all molecules, or of some that are evenly spread."""
    length = molecule_of(case).length
    molecules = case.particles // length
    chosen = np.arange(molecules) if wanted is None else spread_ids(wanted, molecules)
    return chosen[:, None] * length + np.arange(length)


def modes_of(molecule: Molecule) -> theory.NormalModes:
    """Normal modes of its springs."""
    if molecule.topology == "ring":
        return theory.ring_modes(molecule.length)
    if molecule.arms is not None:
        return theory.star_modes(molecule.arms, (molecule.length - 1) // molecule.arms)
    return theory.linear_modes(molecule.length)


def spring_of(molecule: Molecule) -> theory.Spring | None:
    """The springs between beads; None where beads feel anything else, and Rouse's theory ends."""
    bond = molecule.bond
    if molecule.bending is not None or molecule.pair is not None:
        return None
    if bond.rule == "harmonic":
        return theory.spring(K=bond.K)
    if bond.rule == "spring" and bond.length == 0:
        return theory.spring(k=bond.k)
    return None


def without_bonds(case: Case) -> theory.Transport | None:
    """Transport coefficients of the same fluid of single particles."""
    fluid = dataclasses.replace(case.fluid, molecule=None)
    return setting.transport(dataclasses.replace(case, fluid=fluid, observe=(), trajectory=None))


def rouse_times_of(case: Case) -> theory.RouseTimes | None:
    """Relaxation times of molecules whose beads have the friction of free particles."""
    coefficients, spring = without_bonds(case), spring_of(molecule_of(case))
    if coefficients is None or spring is None:
        return None
    friction = case.fluid.kT / coefficients.diffusion
    return theory.rouse_times(modes_of(molecule_of(case)), friction, K=spring.K)


def stress_in_shear(case: Case) -> theory.ShearStress | None:
    """Viscosity (dynamic) and normal-stress differences of Rouse molecules in steady shear."""
    c, times = without_bonds(case), rouse_times_of(case)
    if c is None or times is None:
        return None
    fluid = case.fluid
    modulus = fluid.density / molecule_of(case).length * fluid.kT
    eta = c.viscosity * setting.mass_density(case)
    return theory.maxwell_shear(case.box.shear_rate, modulus, times.stress, eta)


def bond_viscosity(case: Case) -> float | None:
    """What bonds add to the viscosity (dynamic) of slow flow; None without a theory.

    Of springs without a length of their own it is that of any flow.
    """
    molecule, c, times = molecule_of(case), without_bonds(case), rouse_times_of(case)
    if c is None:
        return None
    molecules = case.fluid.density / molecule.length
    if times is not None:
        return molecules * case.fluid.kT * float(times.stress.sum())
    d, kT = case.box.dimension, case.fluid.kT
    square = molecule.mean_square_bond(d, kT) if molecule.length == 2 else None
    if square is None:
        return None
    return theory.dumbbell_viscosity(molecules, kT / c.diffusion, square / d)


def bond_in_shear(case: Case) -> float | None:
    """Mean square bond length in steady shear: Rouse, of trimers with hydrodynamic interaction."""
    c, times, bond = without_bonds(case), rouse_times_of(case), free_bond(case)
    if c is None or times is None or bond is None:
        return None
    molecule, rate, kT = molecule_of(case), case.box.shear_rate, case.fluid.kT
    spring = spring_of(molecule)
    if molecule.topology == "chain" and molecule.length == 3 and case.box.dimension == 3 and spring:
        eta = c.viscosity * setting.mass_density(case)
        radius = kT / (6 * math.pi * eta * c.diffusion)
        try:
            return theory.trimer_bond_length(spring.K, rate, eta, radius, kT) ** 2
        except ValueError:  # bonds shorter than beads are large
            return None
    modes, dimension = modes_of(molecule), case.box.dimension
    return theory.size_in_shear(modes, rate, float(times.stress[0]), bond, dimension).bond


def free_bond(case: Case) -> float | None:
    """Mean square length of a bond that is not in a ring; None without a theory."""
    spring = spring_of(molecule_of(case))
    if spring is None:
        return None
    return theory.mean_square_bond(K=spring.K, dimension=case.box.dimension, kT=case.fluid.kT)


def gyration(r: Array) -> Array:
    """Gyration tensors (molecules, d, d) of beads at r (molecules, length, d)."""
    arm = r - r.mean(axis=1, keepdims=True)
    return np.einsum("mia,mib->mab", arm, arm) / r.shape[1]
