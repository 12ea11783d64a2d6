"""Which particle of a file is which bead: found by following its bonds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError

if TYPE_CHECKING:
    from mesokit.method.mpcd.molecule import Molecule

Numbers = NDArray[np.int64]
SHOWN = 4  # sizes of molecules that a message lists


def bead_order(bonds: Numbers, particles: int, molecule: Molecule) -> Numbers:
    """The particle (particles,) that is each bead, molecule by molecule as `molecule` counts them.

    Molecules come in the order of their lowest particle; a chain begins at its lower end, a ring
    goes from its lowest particle to that one's lower neighbour, arms of a star come in the order
    of their innermost beads. Particles that are in order stay where they are.

    Parameters: `bonds` (bonds, 2), numbers of the particles that are linked, from 0. Raises
    CaseError unless these are the bonds of such molecules and no others.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    links = np.unique(np.sort(bonds, axis=1), axis=0)
    graph = coo_matrix((np.ones(len(links)), links.T), shape=(particles, particles))
    count, member = connected_components(graph, directed=False)
    sizes = np.unique(np.bincount(member))
    if sizes.tolist() != [molecule.length]:
        shown = ", ".join(map(str, sizes[:SHOWN])) + ", ..." * (len(sizes) > SHOWN)
        raise CaseError(
            f"its bonds make molecules of {shown} particles; expected {molecule.length} in each "
            "(fluid.molecule.length)"
        )
    ends = np.concatenate([links, links[:, ::-1]])
    ends = ends[np.lexsort(ends.T[::-1])]
    degree = np.bincount(ends[:, 0], minlength=particles)
    if not _fits(degree, member, molecule):
        raise CaseError(_other_bonds(molecule))
    neighbours = np.full((particles, max(2, int(degree.max()))), -1)
    column = np.arange(len(ends)) - np.repeat(np.cumsum(degree) - degree, degree)
    neighbours[ends[:, 0], column] = ends[:, 1]

    first = np.full(count, particles)
    np.minimum.at(first, member, np.arange(particles))
    begin = np.full(count, particles)
    starts = np.flatnonzero(degree == _degree_of_first(molecule))
    np.minimum.at(begin, member[starts], starts)
    order = _beads(neighbours, begin[np.argsort(first)], molecule)
    found = order[:, np.array(molecule.bonds)].reshape(-1, 2)
    if not np.array_equal(np.unique(np.sort(found, axis=1), axis=0), links):
        raise CaseError(_other_bonds(molecule))
    return order.ravel()


def _fits(degree: Numbers, member: Numbers, molecule: Molecule) -> bool:
    """Whether the beads of every molecule have as many bonds as they should, in any order."""
    wanted = np.bincount(np.ravel(molecule.bonds), minlength=molecule.length)
    there = degree[np.lexsort((degree, member))].reshape(-1, molecule.length)
    return bool((there == np.sort(wanted)).all())


def _degree_of_first(molecule: Molecule) -> int:
    """Number of bonds of the bead at which a molecule is entered."""
    if molecule.topology == "star" and molecule.arms is not None and molecule.arms > 2:
        return molecule.arms
    return 2 if molecule.topology == "ring" else 1


def _beads(neighbours: Numbers, begin: Numbers, molecule: Molecule) -> Numbers:
    """Particles (molecules, length) in the order of the beads, from the one to begin at on."""
    arms = molecule.arms or 1
    if arms > 2:
        inner = neighbours[begin, :arms].T
        steps = (molecule.length - 1) // arms
        return np.concatenate(
            [begin[:, None], *(_path(neighbours, begin, bead, steps) for bead in inner)], axis=1
        )
    rest = _path(neighbours, begin, neighbours[begin, 0], molecule.length - 1)
    path = np.concatenate([begin[:, None], rest], axis=1)
    if arms == 2:  # a chain that is counted from its middle
        middle = molecule.length // 2
        path = np.concatenate([path[:, middle::-1], path[:, middle + 1 :]], axis=1)
    return path


def _path(neighbours: Numbers, before: Numbers, here: Numbers, steps: int) -> Numbers:
    """So many particles (molecules, steps) along a line of bonds, away from the one before."""
    path = [here]
    for _ in range(steps - 1):
        one, other = neighbours[here, 0], neighbours[here, 1]
        before, here = here, np.where(one == before, other, one)
        path.append(here)
    return np.stack(path, axis=1)


def _other_bonds(molecule: Molecule) -> str:
    arms = f" with {molecule.arms} arms of one length" if molecule.arms else ""
    return (
        f"its bonds differ from those of the case; expected each molecule to be a "
        f"{molecule.topology} of {molecule.length} beads{arms} (fluid.molecule)"
    )
