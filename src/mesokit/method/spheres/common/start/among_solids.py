"""Random places beside solids of any shape."""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import solids_of
from mesokit.loops.neighbours import near_pairs

Array = NDArray[np.float64]
TRIES = 2000  # of all that have no place yet


def among_solids(case: Case, diameters: Array, closed: tuple[bool, ...]) -> Array:
    """Places (n, d) in the free room, none on another. Raises CaseError where one finds none.

    All that have no place yet draw one, again and again; of two that meet the later gives way.
    """
    solids, size = solids_of(case), np.array(case.box.size, float)
    random = np.random.default_rng(case.run.seed)
    period = np.where(closed, 0.0, size)
    places, left = np.zeros((len(diameters), len(size))), np.arange(len(diameters))
    placed = np.zeros(0, np.int64)
    for _ in range(TRIES):
        places[left] = random.uniform(0.0, 1.0, (len(left), len(size))) * size
        free = left[solids.distance(places[left]) > 0.5 * diameters[left]]
        order = np.concatenate([placed, free])
        one, two, distance = near_pairs(places[order], float(diameters.max()), period)
        one, two = order[np.minimum(one, two)], order[np.maximum(one, two)]
        meets = distance < 0.5 * (diameters[one] + diameters[two])
        placed = np.setdiff1d(order, two[meets])
        left = np.setdiff1d(left, placed)
        if not len(left):
            return places
    raise CaseError(
        f"spheres: no room found for {len(left)} of {len(diameters)} at random places outside the "
        "solids; expected fewer or smaller"
    )
