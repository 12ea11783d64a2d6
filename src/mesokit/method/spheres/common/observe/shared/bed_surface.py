"""Heights of grains above the floor, and which of them hang together."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.observe.protocol import pull_axis
from mesokit.seam.engine import Array, RunningSpheres


def horizontal(case: Case, given: str | None, quantity: str) -> tuple[int, int]:
    """The axis of gravity and a horizontal one (the first unless given). Raises CaseError."""
    pull = pull_axis(case)
    if pull is None:
        raise CaseError(f"{quantity}: expected gravity along one axis")
    axes = case.box.axes
    allowed = [axis for axis in axes if axis != axes[pull]]
    if given is not None and given not in allowed:
        raise CaseError(f"axis = {given!r}: expected a horizontal one, {' or '.join(allowed)}")
    return pull, axes.index(allowed[0] if given is None else given)


def heights_of(case: Case, spheres: RunningSpheres, pull: int) -> Array:
    """Heights of centres above the plate below; without, above the lowest point of all grains."""
    place = spheres.positions(unwrapped=True)[:, pull]
    up, length = -np.sign(case.spheres.gravity[pull]), float(case.box.size[pull])
    if pull in closed_axes(case):
        return np.asarray(place if up > 0 else length - place)
    return np.asarray(up * place - (up * place - 0.5 * spheres.diameters()).min())


def main_mass(places: Array, diameters: Array, period: Array, gap: float) -> NDArray[np.bool_]:
    """Which grains belong to the most that hang together; a period of 0 does not repeat.

    >>> rows = np.array([[0.5, 1.0], [1.6, 1.0], [5.0, 5.0]])
    >>> main_mass(rows, np.ones(3), np.zeros(2), 0.2)
    array([ True,  True, False])
    """
    label = clusters(places, diameters, period, gap)
    return np.asarray(label == np.bincount(label).argmax())


def clusters(places: Array, diameters: Array, period: Array, gap: float) -> NDArray[np.int64]:
    """Number of the cluster of each sphere: surfaces of neighbours are nearer than the gap."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(places)
    one, other, distance = near_pairs(places, float(diameters.max()) + gap, period)
    near = distance < 0.5 * (diameters[one] + diameters[other]) + gap
    ends = (one[near], other[near])
    graph = coo_array((np.ones(len(ends[0]), bool), ends), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    return np.asarray(label, np.int64)
