"""Theory of molecules: modes of their springs, relaxation and diffusion."""

import dataclasses
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.selection import (
    group_of,
    kinds_of_molecules,
    molecule_of,
    of_fluid,
)
from mesokit.method.mpcd.molecule import FLUID, Molecule

Array = NDArray[np.floating[Any]]
FAST = 0.5  # radians of a bond in one flight: from here on Rouse's times are off by a tenth
CROWDED = 0.03  # of D: what pairs of beads take, from which on those of three matter


def modes_of(molecule: Molecule) -> theory.NormalModes:
    """Normal modes of its springs."""
    if molecule.topology == "free":
        return theory.network_modes(molecule.bonds, molecule.length)
    if molecule.topology == "ring":
        return theory.ring_modes(molecule.length)
    if molecule.arms is not None:
        return theory.star_modes(molecule.arms, (molecule.length - 1) // molecule.arms)
    return theory.linear_modes(molecule.length)


def springs_of(case: Case, kind: int | str = 1) -> theory.Spring | None:
    """The springs of molecules; None where beads feel anything else, of other kinds too."""
    solutes = case.solutes
    dissolved = solutes is not None and not of_fluid(case, kind)
    if dissolved and solutes is not None and not solutes.ideal(solutes.index_of(kind)):
        return None
    return spring_of(molecule_of(case, kind=kind))


def spring_of(molecule: Molecule) -> theory.Spring | None:
    """The springs between beads; None where beads feel anything else, and Rouse's theory ends."""
    if molecule.bending is not None or molecule.pair is not None:
        return None
    return molecule.bond.spring()


def modes_at_rest(case: Case, kind: int | str = 1) -> theory.NormalModes:
    """Normal modes whose eigenvalues give the swing of springs at rest, as sub-steps move them.

    Velocity Verlet makes each spring mode a little softer, see `theory.verlet_swing`.
    """
    molecule, spring = molecule_of(case, kind=kind), springs_of(case, kind)
    modes = modes_of(molecule)
    if spring is None or molecule.propagation == "exact":
        return modes
    substep, mass = substep_of(case, kind)
    stiffness = (spring.k * modes.eigenvalues[1:]).tolist()
    swing = np.array([1.0, *(theory.verlet_swing(k, substep, mass) for k in stiffness)])
    return modes._replace(eigenvalues=modes.eigenvalues / swing)


def bond_at_rest(case: Case, kind: int | str = 1) -> float:
    """By which factor sub-steps enlarge the mean square length of bonds at rest."""
    modes, slow = modes_of(molecule_of(case, kind=kind)), modes_at_rest(case, kind)
    return float(np.mean(modes.eigenvalues[1:] / slow.eigenvalues[1:]))


def ends_at_rest(case: Case, kind: int | str, bond: float) -> float:
    """Mean square end-to-end distance of chains at rest, by that of a free bond."""
    modes = modes_at_rest(case, kind)
    across = modes.vectors[-1, 1:] - modes.vectors[0, 1:]
    return bond * float((across**2 / modes.eigenvalues[1:]).sum())


def swing_of_flight(case: Case) -> float:
    """By how much the fastest bond of the fluid's molecules turns in one flight, in radians."""
    fluid, molecule = case.fluid, molecule_of(case, kind=FLUID)
    return molecule.frequency(case.box.dimension, fluid.kT, fluid.mass) * fluid.timestep


def without_bonds(case: Case) -> theory.Transport | None:
    """Transport coefficients of the same fluid of single particles; None if it has solutes."""
    return without_solutes(case) if case.solutes is None else None


def without_solutes(case: Case) -> theory.Transport | None:
    """Transport coefficients of the same fluid of single particles, without solutes."""
    fluid = dataclasses.replace(case.fluid, molecule=None)
    bare: dict[str, Any] = {"solutes": None, "observe": (), "trajectory": None, "log": None}
    return setting.transport(dataclasses.replace(case, fluid=fluid, **bare))


def solvent_of(case: Case) -> theory.Transport | None:
    """Transport coefficients of the solvent of solutes; None if it has molecules."""
    return without_solutes(case) if case.fluid.molecule is None else None


def rouse_times_of(case: Case, kind: int | str = 1) -> theory.RouseTimes | None:
    """Relaxation times of molecules whose beads have the friction of free particles."""
    molecule, friction = molecule_of(case, kind=kind), friction_of(case, kind)
    spring = springs_of(case, kind)
    if friction is None or spring is None:
        return None
    return theory.rouse_times(modes_of(molecule), friction, K=spring.K)


def longest_relaxation(case: Case) -> tuple[float, str] | None:
    """The time of the slowest normal mode of all molecules, and the theory; None without one."""
    known = [(mode_times_of(case, kind)[0], kind) for kind in kinds_of_molecules(case)]
    times = [(float(one.mode[0]), kind) for one, kind in known if one is not None]
    time, kind = max(times, key=lambda one: one[0], default=(None, None))
    if time is None:
        return None
    alone = kind == FLUID or case.solutes is None or case.solutes.solvent == "random"
    return time, "Rouse" if alone else "Zimm"


def stirring_diffusion(case: Case, boxed: bool = False) -> float | None:
    """Diffusion coefficient of a particle of the fluid with the flow that it stirs up; None without
    a theory. In 3D that of a large box unless `boxed`, in 2D there is none but in this box.

    Of particles that fly a cell and more molecular chaos holds, and the former is no better.
    """
    alone, box = without_bonds(case), case.box
    if alone is None:
        return None
    if setting.mean_free_path(case) >= 1:
        return alone.diffusion
    fluid = case.fluid
    size = box.size if boxed or box.dimension == 2 else None
    return theory.self_diffusion(
        box.dimension, alone.diffusion, alone.viscosity, fluid.density, size, fluid.kT, fluid.mass
    )


def self_diffusion(case: Case) -> tuple[float, str]:
    """Diffusion coefficient of a particle of a simple fluid in this box, nan without a theory, and
    a note: with the flow that it stirs up, or between walls molecular chaos."""
    quiet = not case.walls and setting.mean_free_path(case) < 1
    stirring = stirring_diffusion(case, boxed=True) if quiet else None
    if stirring is not None:
        return stirring, f"approximate: {setting.STIRRING}"
    alone = free_diffusion(case)
    return math.nan if alone is None else alone, setting.chaos(case, setting.STIRRED)


def substep_of(case: Case, kind: int | str = 1) -> tuple[float, float]:
    """Time of a sub-step in which the beads of molecules move, and their mass."""
    fluid, solutes, d = case.fluid, case.solutes, case.box.dimension
    if solutes is None or of_fluid(case, kind):
        molecule = molecule_of(case, kind=kind)
        number = molecule.number_of_substeps(d, fluid.timestep, fluid.kT, fluid.mass)
        return fluid.timestep / number, fluid.mass
    mass = solutes.masses[solutes.index_of(kind)]
    return fluid.timestep / solutes.number_of_substeps(d, fluid), mass


def rouse_note(case: Case) -> str:
    """Note on Rouse's theory where beads are taken to have the friction of free particles."""
    if case.solutes is not None and case.fluid.molecule is not None:
        return setting.caveat(case)
    if case.solutes is None and (turns := swing_of_flight(case)) > FAST:
        return f"approximate: Rouse; bonds turn by {turns:.2g} rad in one flight"
    if case.solutes is None and setting.mean_free_path(case) < 1:
        return "approximate: Rouse; flow that a bead stirs up carries neighbours with it"
    if case.solutes is not None:
        return "approximate: Rouse; beads that share a cell lose less momentum than apart"
    return "Rouse; beads with the friction of free particles"


def friction_of(case: Case, kind: int | str = 1) -> float | None:
    """kT over the diffusion coefficient of a bead alone; None in a fluid with memory."""
    # beads of one molecule are stirred by the same flow, which in 2D is as large as the box: what
    # their difference is what they do within a bond's length of each other
    if case.solutes is not None and case.solutes.solvent == "fluid":
        return None
    if case.solutes is not None or case.box.dimension == 2:
        diffusion = free_diffusion(case, kind=kind)
    else:
        diffusion = stirring_diffusion(case)
    return None if diffusion is None else case.fluid.kT / diffusion


def free_diffusion(
    case: Case, of: str = "beads", kind: int | str | None = None, alone: bool = False
) -> float | None:
    """Diffusion coefficient of a particle or bead by molecular chaos; None if unknown.

    In a fluid of molecules it is that in the same fluid without bonds. Beads that are bound to none
    meet the others unless they are to be `alone`; those of molecules are as if alone.
    """
    fluid, solutes = case.fluid, case.solutes
    if solutes is None or of == "particles" or of_fluid(case, kind):
        fluid_alone = without_solutes(case)
        return None if fluid_alone is None else fluid_alone.diffusion
    if fluid.species or not fluid.thermostat.canonical:
        return None
    if solutes.solvent_pair is not None:
        return fluid.kT / hits_of(case, kind)
    place = solutes.index_of(1 if kind is None else kind)
    lonely = alone or solutes.molecule(place) is not None
    others = [] if lonely else others_of(case, place)
    return fluid.collision.bead_diffusion(setting.gas(case), solutes.masses[place], others)


def others_of(case: Case, place: int) -> list[tuple[float, float]]:
    """How many other beads there are in a cell, kind by kind, for a bead of one, and their mass."""
    solutes = case.solutes
    assert solutes is not None
    numbers = [polymer.number * polymer.length for polymer in solutes.polymers]
    numbers[place] -= 1
    volume = free_volume(case)
    found = zip(numbers, solutes.masses, strict=True)
    return [(number / volume, mass) for number, mass in found if number]


def crowd_note(case: Case, kind: int | str) -> str:
    """Note on the diffusion coefficient of beads alone that share cells with others."""
    assert case.solutes is not None
    place = case.solutes.index_of(kind)
    if not case.solutes.ideal(place):
        return "approximate: molecular chaos; as if beads felt no others"
    alone, among = free_diffusion(case, kind=kind, alone=True), free_diffusion(case, kind=kind)
    if alone is not None and among is not None and among < (1.0 - CROWDED) * alone:
        return "approximate: molecular chaos; beads that share cells two at a time"
    return "molecular chaos; beads that share cells two at a time"


def hits_of(case: Case, kind: int | str | None = None) -> float:
    """Friction by hits of a bead that acts on the fluid by a potential (Enskog)."""
    fluid, solutes = case.fluid, case.solutes
    assert solutes is not None
    mass = solutes.masses[solutes.index_of(1 if kind is None else kind)]
    size = solutes.radius(fluid.kT), fluid.density, mass
    return theory.enskog_friction(*size, case.box.dimension, fluid.kT, fluid.mass)


class Solution(NamedTuple):
    """Ideal chains or single beads in a fluid at rest, for Kirkwood's and Zimm's theories."""

    beads: int
    friction: float
    viscosity: float
    bond_length: float
    kT: float


def solution_of(case: Case, kind: int | str) -> Solution | None:
    """Chains or monomers of a kind that drag the fluid along, in 3D without walls; None for
    others."""
    assert case.solutes is not None
    place = case.solutes.index_of(kind)
    molecule, kT = case.solutes.molecule(place), case.fluid.kT
    alone, solvent = free_diffusion(case, kind=kind), solvent_of(case)
    if molecule is None:
        bond = 1.0 if case.solutes.ideal(place) else None
    else:
        bond = free_bond(case, kind) if molecule.topology == "chain" else None
    if case.solutes.solvent_pair is not None or case.box.dimension == 2 or case.walls:
        return None
    if bond is None or alone is None or solvent is None:
        return None
    eta = solvent.viscosity * case.fluid.density * case.fluid.mass
    return Solution(molecule.length if molecule else 1, kT / alone, eta, math.sqrt(bond), kT)


def kirkwood(case: Case, kind: int | str) -> float | None:
    """Diffusion coefficient of monomers and ideal chains that drag the fluid along, in this cubic
    box; None for other molecules and boxes."""
    solutes, size, kT = case.solutes, case.box.size, case.fluid.kT
    assert solutes is not None
    if len(set(size)) > 1:
        return None
    if solutes.solvent_pair is not None:
        solvent, single = solvent_of(case), solutes.molecule(solutes.index_of(kind)) is None
        flat = case.box.dimension == 2 or case.walls or case.fluid.species
        if solvent is None or flat or not single:
            return None
        eta = solvent.viscosity * case.fluid.density * case.fluid.mass
        friction = hits_of(case, kind)
        return theory.slip_sphere_diffusion(solutes.radius(kT), eta, friction, size[0], kT)
    solution = solution_of(case, kind)
    if solution is None:
        return None
    free = theory.kirkwood_in_cells(*solution)
    return theory.diffusion_in_box(free, size[0], solution.viscosity, solution.kT)


def mode_times_of(case: Case, kind: int | str = 1) -> tuple[theory.RouseTimes | None, str]:
    """Relaxation times of molecules at rest, and a note with the theory, Rouse or Zimm."""
    if case.solutes is None or case.solutes.solvent == "random" or of_fluid(case, kind):
        return rouse_times_of(case, kind), rouse_note(case)
    note = "approximate: Zimm; hydrodynamics pre-averaged, large box"
    solution = solution_of(case, kind)
    if solution is None or solution.beads == 1:
        return None, "no theory of these molecules in a fluid"
    try:
        return theory.zimm_times(*solution), note
    except ValueError:  # beads so large for their bonds that they would overlap
        return None, "no theory of bonds as short as these"


def least_times_of(case: Case, kind: int | str = 1) -> theory.RouseTimes | None:
    """Relaxation times for error bars: those of theory.

    Of solutes in a fluid of molecules, and of that fluid, there is none: it takes those of the
    solutes in the fluid without its bonds, which make them longer, and those of the fluid alone.
    """
    if case.solutes is None or case.fluid.molecule is None:
        return mode_times_of(case, kind)[0]
    alone = dataclasses.replace(case, observe=(), trajectory=None, log=None)
    if of_fluid(case, kind):
        return mode_times_of(dataclasses.replace(alone, solutes=None))[0]
    fluid = dataclasses.replace(case.fluid, molecule=None)
    return mode_times_of(dataclasses.replace(alone, fluid=fluid), kind)[0]


def springs_in(case: Case) -> list[tuple[int, theory.RouseTimes]]:
    """Of all kinds of molecules whose times are known: how many there are, and these times."""
    kinds = kinds_of_molecules(case)
    known = [(group_of(case, "beads", kind).number, least_times_of(case, kind)) for kind in kinds]
    return [(number, times) for number, times in known if times is not None]


def free_bond(case: Case, kind: int | str = 1) -> float | None:
    """Mean square length of a bond that is not in a ring; None without a theory."""
    spring = springs_of(case, kind)
    if spring is None:
        return None
    return theory.mean_square_bond(K=spring.K, dimension=case.box.dimension, kT=case.fluid.kT)


def gyration(r: Array) -> Array:
    """Gyration tensors (molecules, d, d) of beads at r (molecules, length, d)."""
    arm = r - r.mean(axis=1, keepdims=True)
    return np.einsum("mia,mib->mab", arm, arm) / r.shape[1]
