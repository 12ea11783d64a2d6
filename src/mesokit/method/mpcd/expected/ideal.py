"""Theory of ideal molecules at rest, and of beads that drift and spread freely."""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import (
    ends_at_rest,
    free_bond,
    free_diffusion,
    modes_at_rest,
    modes_of,
    rouse_note,
    springs_of,
)
from mesokit.method.mpcd.expected.selection import Group, of_fluid
from mesokit.method.mpcd.expected.traps import at_rest, pulls_on, trapped
from mesokit.method.mpcd.molecule import Molecule
from mesokit.potential.thermal import mean_square


def undisturbed(case: Case) -> bool:
    """Whether molecules are in equilibrium at rest, and no wall or body is in their way."""
    return not (case.walls or case.bodies or setting.flowing(case))


def mean_shape(case: Case, kind: int | str, group: Group) -> NDArray[np.float64] | None:
    """Mean places (beads, d) of an ideal molecule about its centre: all 0 at rest; with pulls that
    cancel within each molecule where the springs hold them. None where there is no theory.

    What holds or stretches other kinds does not matter to a molecule that does not feel them, as
    long as it drives no flow: all are in equilibrium then, each by Boltzmann's distribution.
    """
    molecule, d = group.molecule, case.box.dimension
    if molecule is None or free_bond(case, kind) is None:
        return None
    if undisturbed(case):
        return np.zeros((group.length, d))
    spring, solutes = springs_of(case, kind), case.solutes
    if spring is None or solutes is None or of_fluid(case, kind) or trapped(case, kind):
        return None
    alone = dataclasses.replace(solutes, pulls=(), traps=())
    every = range(len(solutes.polymers))
    balanced = all(at_rest(case, 1 + place) for place in every)
    if not balanced or not undisturbed(dataclasses.replace(case, solutes=alone)):
        return None
    pulled = pulls_on(case, solutes.index_of(kind))
    return theory.pulled_shape(modes_of(molecule), pulled, spring.K)


def ideal_sizes(case: Case, kind: int | str, group: Group) -> tuple[float, float]:
    """Mean squares of the radius of gyration and, of chains, of the end-to-end distance.

    nan where there is no theory: beads that repel one another, walls, flows.
    """
    molecule, mean = group.molecule, mean_shape(case, kind, group)
    bond = free_bond(case, kind) if mean is not None else None
    if molecule is None or mean is None or bond is None:
        return math.nan, math.nan
    square = theory.mean_square_gyration(modes_at_rest(case, kind), bond)
    square += float((mean**2).sum()) / len(mean)
    if molecule.topology != "chain":
        return square, math.nan
    ends = ends_at_rest(case, kind, bond)
    return square, ends + float(((mean[-1] - mean[0]) ** 2).sum())


def stretched(case: Case, molecule: Molecule) -> float:
    """Length of a stretched chain, or four spreads of few bonds: farther ends are rare."""
    bonds, d, kT = molecule.length - 1, case.box.dimension, case.fluid.kT
    bond = mean_square(molecule.bond_potentials, d, kT, molecule.bond.longest) ** 0.5
    return 1.1 * bond * max(bonds, 4 * bonds**0.5)


class Drift(NamedTuple):
    """Velocity (d,) and diffusion coefficient of centres of mass, and a note on them.

    A velocity is remembered for the time `memory`, beyond that of one flight.
    """

    velocity: NDArray[np.float64]
    diffusion: float
    note: str
    memory: float


def drift_of(case: Case, group: Group, kind: int | str = 1) -> Drift | None:
    """How centres of solutes move in a random solvent that is the same everywhere; None elsewhere.

    A force drives a bead to force/friction, friction = kT/D (Einstein): exact for a bead whose
    velocity is forgotten by a factor at each collision, whatever the timestep. Beads that share a
    cell are driven alike and keep more of it together; that is left out.
    """
    solutes, alone = case.solutes, free_diffusion(case, kind=kind, alone=True)
    if solutes is None or solutes.solvent != "random" or alone is None or case.walls:
        return None
    place = solutes.index_of(kind)
    uniform = case.fluid.force.uniform(case.box.dimension) is not None
    if setting.magnetic(case) or not solutes.ideal(place) or not uniform:
        return None
    mobility = solutes.masses[place] * alone / case.fluid.kT
    single = group.molecule is None
    note = "molecular chaos, exact for a bead alone" if single else rouse_note(case)
    spread = free_diffusion(case, kind=kind) if single else alone / group.length
    assert spread is not None
    fluid, mass = case.fluid, solutes.masses[place] * group.length
    memory = max(spread * mass / fluid.kT - 0.5 * fluid.timestep, 0.0)
    return Drift(setting.uniform_acceleration(case) * mobility, spread, note, memory)


def flow_axis(case: Case, given: str | None = None) -> int:
    """Number of the given axis, else of that along which a force drives the fluid, else of x."""
    axis = setting.driven_axis(case) if given is None else case.box.index(given)
    return 0 if axis is None else axis


def flow_sign(case: Case, axis: int) -> int:
    """-1 where a force drives the fluid backwards along an axis, else 1."""
    return -1 if setting.uniform_acceleration(case)[axis] < 0 else 1
