"""Islands: sites that are linked by neighbours in the same state, or as high."""

import math

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import state_number
from mesokit.method.kinetic_monte_carlo.observe.shared.neighbours import Neighbours


def check_islands(case: Case, state: str | None, level: int | None) -> None:
    """Raise CaseError for a state or a level that has no meaning in a model."""
    if state is not None:
        state_number(case, state)
    if level is not None and case.lattice.model.states():
        raise CaseError(f"level = {show(level)}: only of heights; give a state, or leave it out")


def covered(
    case: Case, sites: NDArray[np.integer], state: str | None, level: int | None
) -> NDArray[np.bool_]:
    """The sites (n,) of islands: in a state, the second unless said; or columns as high as a level,
    the first above the mean height unless said."""
    if case.lattice.model.states():
        return np.asarray(sites == (1 if state is None else state_number(case, state)))
    least = math.floor(float(sites.mean())) + 1 if level is None else level
    return np.asarray(sites >= least)


def islands(
    neighbours: Neighbours, covered: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Sites of each island, and the lowest number of its sites, given which sites (n,) are covered.

    Links are pairs of covered neighbours, over periodic ends too (K. Hoshen and R. Kopelman, Phys.
    Rev. B 14, 3438 (1976), have the same clusters).
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    places = np.flatnonzero(covered)
    if not len(places):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    number = np.full(len(covered), -1, np.int32)
    number[places] = np.arange(len(places))
    number = number.reshape(neighbours.size)
    one, other = [], []
    for there, counts in neighbours.pairs(number):
        linked = counts & (number >= 0) & (there >= 0)
        one.append(number[linked])
        other.append(there[linked])
    rows, columns = np.concatenate(one), np.concatenate(other)
    shape = len(places), len(places)
    links = coo_array((np.ones(len(rows), bool), (rows, columns)), shape=shape)
    _, labels = connected_components(links, directed=False)
    _, first = np.unique(labels, return_index=True)
    return np.bincount(labels), places[first]
