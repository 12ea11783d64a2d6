"""Spheres at random places."""

from typing import Literal, NamedTuple, Self

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.loops.neighbours import near_pairs
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.region import Region, check_region
from mesokit.method.spheres.common.start.protocol import Array, Placed, SphereStart
from mesokit.method.spheres.common.walls import (
    AXIS,
    COLUMNS,
    KIND,
    PLACE,
    PLANE,
    other_walls,
    room_of,
    surface_rows,
)

TRIES = 2000  # of all that have no place yet


@component
class RandomStart(SphereStart):
    """Anywhere, none on another, off the walls.

    Where they are too many to be put in one by one, they begin small and grow while they fly and
    collide (Lubachevsky and Stillinger 1990): from a packing fraction of 0.2 (2D) or 0.1 (3D), by
    0.05 of a thermal velocity, to that of the case.
    """

    rule: Literal["random"] = tag("random")
    region: Either[None, tuple[float, float]] = param(
        None, doc="[from, to] along each axis (the whole box unless said)", unit="length"
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for a region outside the box."""
        try:
            check_region(self.region, case)
        except CaseError as error:
            raise CaseError(f"spheres.start.{error}") from None

    def place(self, case: Case, made: Made) -> Placed:
        from mesokit.method.spheres.hard.grow import grown

        case.spheres.require_room(case.box)
        room = _Room.of(case, self.region)
        if not case.spheres.hard and other_walls(case):
            return Placed(_among_solids(case, made.diameters, room))
        walls = np.concatenate([surface_rows(case).rows, room.walls])
        fraction = case.spheres.fraction(case.box) * room.share
        seed = case.run.seed
        return Placed(grown(case.box.size, room.closed, made.diameters, walls, fraction, seed))


class _Room(NamedTuple):
    """The room for random places: lowest and highest (d,) corner, axes that do not repeat, planes
    that bound it as rows of walls, and the volume of the box over its own."""

    low: Array
    high: Array
    closed: tuple[bool, ...]
    walls: Array
    share: float

    @classmethod
    def of(cls, case: Case, region: Region | None) -> Self:
        """The box, or a region of it, whose sides within the box are walls."""
        size, d = np.array(case.box.size, float), case.box.dimension
        whole = region or [(0.0, length) for length in size]
        low, high = np.array(whole, float).T
        closed, rows = list(room_of(case).closed), []
        for k in np.flatnonzero((low > 0) | (high < size)):
            closed[k] = True
            for place, up in ((low, 1.0), (high, -1.0)):
                row = np.zeros(COLUMNS)
                row[KIND], row[PLACE : PLACE + d], row[AXIS + k] = PLANE, place, up
                rows.append(row)
        share = float(np.prod(size) / np.prod(high - low))
        return cls(low, high, tuple(closed), np.array(rows).reshape(-1, COLUMNS), share)


def _among_solids(case: Case, diameters: Array, room: _Room) -> Array:
    """Random places (n, d) beside solids of any shape. Raises CaseError where one finds none."""
    from mesokit.geometry.solids.solids import solids_of

    solids, size = solids_of(case), np.array(case.box.size, float)
    bounds = room.walls[:, PLACE : PLACE + len(size)], room.walls[:, AXIS : AXIS + len(size)]
    random = np.random.default_rng(case.run.seed)
    places, left = np.zeros((len(diameters), len(size))), np.arange(len(diameters))
    placed, period = np.zeros(0, np.int64), np.where(room.closed, 0.0, size)
    # All that have no place yet draw one, again and again. Of two spheres that overlap, the one
    # that comes later in `order` draws again; spheres that have a place come first.
    for _ in range(TRIES):
        places[left] = random.uniform(0.0, 1.0, (len(left), len(size))) * (room.high - room.low)
        places[left] += room.low
        away = solids.distance(places[left])
        for point, normal in zip(*bounds, strict=True):
            away = np.minimum(away, (places[left] - point) @ normal)
        free = left[away > 0.5 * diameters[left]]
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
