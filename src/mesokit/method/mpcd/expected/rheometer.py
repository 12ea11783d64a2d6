"""Theory of molecules and fluids in shear, steady or changing in time."""

import math

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import (
    Array,
    free_bond,
    friction_of,
    rouse_note,
    rouse_times_of,
    spring_of,
    without_bonds,
)
from mesokit.method.mpcd.expected.selection import molecule_of

FEW = 3  # beads of a molecule up to which the others do not screen what it drags along
FORGOTTEN = 15.0  # relaxation times


def few_in_shear(case: Case) -> theory.ChainInShear | None:
    """Dimers and trimers in steady shear (3D), with hydrodynamic interaction; None for others.

    The particles of longer molecules are mostly beads of others, beside which their own drag one
    another along less than Zimm has it: Rouse's times are nearer (docs/validation/viscoelastic.md).
    """
    if case.solutes is not None:
        return None
    c, friction, molecule = without_bonds(case), friction_of(case), molecule_of(case)
    spring = spring_of(molecule)
    if c is None or friction is None or spring is None or case.box.dimension == 2:
        return None
    if molecule.topology != "chain" or molecule.length > FEW:
        return None
    eta, rate = c.viscosity * setting.mass_density(case), case.box.steady_rate
    try:
        return theory.zimm_shear(molecule.length, rate, spring.K, friction, eta, case.fluid.kT)
    except ValueError:  # bonds shorter than beads are large
        return None


def shear_note(case: Case) -> str:
    """Note on the theory of molecules in shear."""
    if few_in_shear(case) is None:
        return rouse_note(case)
    return "approximate: one molecule in a simple fluid, hydrodynamics averaged over its bonds"


def times_in_shear(case: Case) -> theory.RouseTimes | None:
    """Relaxation times of the molecules of a sheared fluid; None beside solutes."""
    if case.solutes is not None:
        return None
    few = few_in_shear(case)
    return rouse_times_of(case) if few is None else few.times


def stress_in_shear(case: Case) -> theory.ShearStress | None:
    """Viscosity (dynamic) and normal-stress differences of molecules of springs in steady shear."""
    c, times = without_bonds(case), times_in_shear(case)
    if c is None or times is None:
        return None
    eta = c.viscosity * setting.mass_density(case)
    return theory.maxwell_shear(case.box.steady_rate, modulus_of(case), times.stress, eta)


def bond_viscosity(case: Case) -> float | None:
    """Part of bonds in the viscosity (dynamic) of slow flow; None without a theory.

    Of springs without a length of their own it is that of any flow.
    """
    c = without_bonds(case)
    if c is None:
        return None
    molecule, times = molecule_of(case), times_in_shear(case)
    molecules = case.fluid.density / molecule.length
    if times is not None:
        return molecules * case.fluid.kT * float(times.stress.sum())
    d, kT = case.box.dimension, case.fluid.kT
    square = molecule.mean_square_bond(d, kT) if molecule.length == 2 else None
    friction = friction_of(case)
    if square is None or friction is None:
        return None
    return theory.dumbbell_viscosity(molecules, friction, square / d)


def bonds_in_shear(case: Case) -> Array | None:
    """Mean products (d, d) of the components of bonds in steady shear: Rouse, or with hydrodynamic
    interaction."""
    times, bond = times_in_shear(case), free_bond(case)
    if times is None or bond is None:
        return None
    d, number, rate = case.box.dimension, len(molecule_of(case).bonds), case.box.steady_rate
    found = theory.bond_correlation(0.0, times.stress, bond, rate, d, number)
    products = float(found.yy) * np.eye(d)
    products[0, 0] = float(found.xx)
    products[0, 1] = products[1, 0] = float(found.xy)
    return products


def modulus_of(case: Case) -> float:
    """phi kT of a fluid of molecules: their number a volume times kT."""
    return case.fluid.density / molecule_of(case).length * case.fluid.kT


def modes_of_stress(case: Case) -> tuple[float, list[float], float] | None:
    """phi kT, stress times and viscosity (dynamic) without bonds, as theory takes them.

    None for solutes, bonds that are no Hookean springs, and rules without a theory.
    """
    coefficients = without_bonds(case)
    if coefficients is None:
        return None
    viscosity = coefficients.viscosity * setting.mass_density(case)
    if case.fluid.molecule is None:
        return case.fluid.density * case.fluid.kT, [], viscosity
    times = times_in_shear(case)
    if times is None:
        return None
    return modulus_of(case), [float(tau) for tau in times.stress], viscosity


def stress_of_history(case: Case, steps: int, first: int, count: int) -> theory.StressInTime | None:
    """Stress in each of `steps` steps, averaged over `count` repetitions from number `first` on.

    None where there is no theory, and where the run goes on from another one: what that did
    before, its molecules may remember.
    """
    known = modes_of_stress(case)
    if known is None or case.fluid.start.run is not None or case.fluid.force.acts:
        return None
    modulus, times, viscosity = known
    history, timestep = case.box.history, case.fluid.timestep
    # repetitions until the start is forgotten: all later ones are like the last of these
    memory = math.ceil(FORGOTTEN * max(times, default=0.0) / (steps * timestep)) + 1
    number = min(first + count, first + memory)
    time = np.arange(number * steps + 1) * timestep
    strain = np.zeros(len(time))
    if history is not None:  # images keep the speed of the middle of each step
        middles = 0.5 * (time[1:] + time[:-1])
        strain[1:] = timestep * np.cumsum([history.rate_at(t) for t in middles.tolist()])
    found = theory.stress_in_time(time, strain, modulus, times, viscosity)
    weights = np.ones(number - first)
    weights[-1] += count - len(weights)
    parts = (part.reshape(number, steps)[first:] for part in found)
    return theory.StressInTime(*(weights @ part / count for part in parts))


def spreading_time(case: Case) -> float:
    """The time in which momentum spreads over half the height of the box, L^2/(4 pi^2 nu)."""
    coefficients = without_bonds(case)
    assert coefficients is not None
    return case.box.size[1] ** 2 / (4 * math.pi**2 * coefficients.viscosity)
