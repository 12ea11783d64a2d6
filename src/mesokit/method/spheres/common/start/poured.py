"""Spheres that have fallen into a heap."""

from typing import Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.made import Made
from mesokit.method.spheres.common.start.protocol import Placed, SphereStart
from mesokit.method.spheres.common.start.random import RandomStart
from mesokit.method.spheres.common.walls import room_of

APART = 1.003  # diameters of hard and rigid ones while they fall: none lies on another afterwards


@component
class PouredStart(SphereStart):
    """At rest on one another: they have fallen from random places in the box, with friction.

    They fall as grains of low restitution do (Cundall and Strack 1979): soft ones as stiff as the
    springs of the case are, others three thousandths larger than they are, so that they lie a
    hair's breadth from one another.
    """

    rule: Literal["poured"] = tag("poured")
    friction: float = param(0.5, doc="Coulomb's coefficient while they fall", ge=0, le=1e6)

    def check(self, case: Case) -> None:
        """Raise CaseError where nothing falls, or falls for ever."""
        gravity = case.spheres.gravity
        if not gravity:
            raise CaseError("spheres.start: rule = 'poured': expected gravity (spheres.gravity)")
        shut = room_of(case).closed
        held = any(g and closed for g, closed in zip(gravity, shut, strict=True))
        if not held and all(wall.closed_axes for wall in case.walls):
            raise CaseError(
                "spheres.start: rule = 'poured': expected a wall across gravity, such as plates"
            )

    def place(self, case: Case, made: Made) -> Placed:
        """Places for all, and no motion. Raises CaseError if there is no room, or no rest."""
        from mesokit.method.spheres.soft.settle import settled

        self.check(case)
        larger = made._replace(diameters=(1.0 if case.spheres.deforms else APART) * made.diameters)
        first = RandomStart().place(case, larger).positions
        found = settled(case, larger, first, self.friction)
        n, d = found.shape
        return Placed(found, np.zeros((n, d)), np.zeros(n if d == 2 else (n, 3)))
