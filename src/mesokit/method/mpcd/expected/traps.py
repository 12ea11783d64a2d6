"""Where harmonic traps hold solutes, by Boltzmann's distribution."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.method.mpcd.expected.molecules import free_diffusion, spring_of
from mesokit.method.mpcd.molecule import FLUID

Array = NDArray[np.floating[Any]]
LEVEL = 8.0  # relaxation times after which a displacement has levelled off: to 3e-4


class Held(NamedTuple):
    """Mean place (d,) and variance along an axis of the centre of a molecule; of its beads, (N, d)
    and (N,), None where bonds are no Hookean springs; the longest relaxation time, None if not
    known."""

    centre: Array
    centre_variance: float
    mean: Array | None
    variance: Array | None
    time: float | None


def trapped(case: Case, kind: int | str) -> bool:
    """Whether a trap holds some bead of this kind."""
    solutes = case.solutes
    if solutes is None or kind == FLUID:
        return False
    place = solutes.index_of(kind)
    return any(solutes.index_of(trap.kind) == place for trap in solutes.traps)


def pulls_on(case: Case, place: int) -> Array:
    """Constant forces (beads, d) on a molecule of a kind (from 0), as on all others of it."""
    solutes = case.solutes
    assert solutes is not None
    pulled = np.zeros((solutes.beads, case.box.dimension))
    for pull in solutes.pulls:
        pulled[pull.beads(solutes)] += pull.force
    first = solutes.first_bead(place)
    return pulled[first : first + solutes.polymers[place].length]


def at_rest(case: Case, kind: int) -> bool:
    """Whether solutes of a kind drive no flow: a trap holds them, or no force is left over."""
    assert case.solutes is not None
    pulled = pulls_on(case, case.solutes.index_of(kind))
    left = np.abs(pulled.sum(axis=0)).max()
    return trapped(case, kind) or bool(left <= 1e-9 * np.abs(pulled).sum())


def held(case: Case, kind: int | str) -> Held | None:
    """Of solutes in traps; None without a theory: no traps, walls, flows, beads that repel."""
    solutes, fluid = case.solutes, case.fluid
    if solutes is None or not trapped(case, kind) or not fluid.thermostat.canonical:
        return None
    place, d = solutes.index_of(kind), case.box.dimension
    driving = any(not at_rest(case, 1 + other) for other in range(len(solutes.polymers)))
    crowded = bool(case.bodies) or (solutes.solvent_pair is not None and solutes.beads > 1)
    if case.walls or case.box.sheared or fluid.force.acts or driving or crowded:
        return None
    if not solutes.ideal(place):
        return None
    stiffness, pulled = np.zeros(solutes.beads), pulls_on(case, place)
    weighted = np.zeros((solutes.beads, d))
    for trap in solutes.traps:
        stiffness[trap.beads(solutes)] += trap.k
        weighted[trap.beads(solutes)] += trap.k * np.array(trap.centre)
    first, length = solutes.first_bead(place), solutes.polymers[place].length
    one = slice(first, first + length)  # as all others of its kind
    k, total = stiffness[one], weighted[one] + pulled
    molecule = solutes.molecule(place)
    spring = None if molecule is None else spring_of(molecule)
    if molecule is not None and spring is None:
        if np.ptp(k) > 0 or np.ptp(weighted[one], axis=0).any():
            return None
        middle = total.sum(axis=0) / k.sum()
        return Held(middle, fluid.kT / float(k.sum()), None, None, None)
    bonds, stiff = ((), 0.0) if molecule is None or spring is None else (molecule.bonds, spring.k)
    shape = theory.trapped_shape(bonds, stiff, k, np.zeros_like(total), total, fluid.kT)
    alone = free_diffusion(case, kind=kind)
    slowest = float(np.linalg.eigvalsh(shape.covariance)[-1])
    time = None if alone is None else slowest / alone
    variances = shape.centre_variance, shape.mean, np.diag(shape.covariance)
    return Held(shape.centre, *variances, time)


def squares_from_middle(places: Array, share: Array, length: float) -> Array:
    """Square distances (n,) of places from the mean place of a distribution (n,) in a periodic
    box, by the shorter way round."""
    turns = np.angle(share @ np.exp(2j * np.pi * places / length))
    away = places - turns * length / (2 * np.pi)
    return np.asarray((away - length * np.rint(away / length)) ** 2)
