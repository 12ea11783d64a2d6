"""Spheres at random places."""

from typing import Literal

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.among_solids import among_solids
from mesokit.method.spheres.common.start.protocol import Placed, SphereStart
from mesokit.method.spheres.common.wall.surfaces import other_walls, room_of, surface_rows


@component
class RandomStart(SphereStart):
    """Anywhere, none on another, off the walls.

    Where they are too many to be put in one by one, they begin small and grow while they fly and
    collide (Lubachevsky and Stillinger 1990): from a packing fraction of 0.2 (2D) or 0.1 (3D), by
    0.05 of a thermal velocity, to that of the case.
    """

    rule: Literal["random"] = tag("random")

    def place(self, case: Case, made: Made) -> Placed:
        """Places for all. Raises CaseError where there is no room."""
        from mesokit.method.spheres.hard.grow import grown

        case.spheres.require_room(case.box)
        if not case.spheres.hard and other_walls(case):
            return Placed(among_solids(case, made.diameters, room_of(case).closed))
        walls = surface_rows(case).rows
        fraction = case.spheres.fraction(case.box)
        closed = room_of(case).closed
        return Placed(grown(case.box.size, closed, made.diameters, walls, fraction, case.run.seed))
