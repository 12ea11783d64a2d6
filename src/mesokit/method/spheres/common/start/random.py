"""Spheres at random places."""

from typing import Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.protocol import Array, Placed, SphereStart
from mesokit.method.spheres.common.walls import other_walls, room_of, surface_rows

TRIES = 2000  # of all that have no place yet


@component
class RandomStart(SphereStart):
    """Anywhere, none on another, off the walls.

    Where they are too many to be put in one by one, they begin small and grow while they fly and
    collide (Lubachevsky and Stillinger 1990): from a packing fraction of 0.2 (2D) or 0.1 (3D), by
    0.05 of a thermal velocity, to that of the case.
    """

    rule: Literal["random"] = tag("random")

    def place(self, case: Case, made: Made) -> Placed:
        from mesokit.method.spheres.hard.grow import grown

        case.spheres.require_room(case.box)
        closed = room_of(case).closed
        if not case.spheres.hard and other_walls(case):
            return Placed(_among_solids(case, made.diameters, closed))
        walls, fraction = surface_rows(case).rows, case.spheres.fraction(case.box)
        return Placed(grown(case.box.size, closed, made.diameters, walls, fraction, case.run.seed))


def _among_solids(case: Case, diameters: Array, closed: tuple[bool, ...]) -> Array:
    """Random places (n, d) beside solids of any shape. Raises CaseError where one finds none."""
    from mesokit.geometry.solids.solids import solids_of

    solids, size = solids_of(case), np.array(case.box.size, float)
    random = np.random.default_rng(case.run.seed)
    places, left = np.zeros((len(diameters), len(size))), np.arange(len(diameters))
    placed, period = np.zeros(0, np.int64), np.where(closed, 0.0, size)
    # All that have no place yet draw one, again and again. Of two spheres that overlap, the one
    # that comes later in `order` draws again; spheres that have a place come first.
    for _ in range(TRIES):
        places[left] = random.uniform(0.0, 1.0, (len(left), len(size))) * size
        free = left[solids.distance(places[left]) > 0.5 * diameters[left]]
        order = np.concatenate([placed, free])
        one, other, distances = near_pairs(places[order], float(diameters.max()), period)
        overlap = distances < 0.5 * (diameters[order[one]] + diameters[order[other]])
        placed = np.setdiff1d(order, order[np.maximum(one, other)[overlap]])
        left = np.setdiff1d(left, placed)
        if not len(left):
            return places
    raise CaseError(
        f"spheres: no room found for {len(left)} of {len(diameters)} at random places outside the "
        "solids; expected fewer or smaller"
    )
