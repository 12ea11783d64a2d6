"""How far plates have moved into the box, and what part of the space between them grains fill."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from mesokit.case.component import component, show, tag
from mesokit.errors import CaseError
from mesokit.geometry import walls
from mesokit.method.spheres.common.kinds import ball_volume
from mesokit.method.spheres.common.observe.protocol import OfSpheres, Samples
from mesokit.method.spheres.common.observe.wall_force import surface_names
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Array, Comparison, Result

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.spheres.rigid.engine.engine import RigidEngine


def moved_surfaces(case: Case) -> list[int]:
    """Numbers of the surfaces of plates that move along their normal, or are pushed."""
    found = []
    for number, (_, surface, _) in enumerate(walls.surfaces(case)):
        if surface.contact is not None and surface.contact.drives:
            found.append(number)
    return found


@component
class PlateMotion(OfSpheres):
    """Displacement of plates that move or are pushed, in time, and the packing between all plates.

    The packing fraction is that of the box less the space that plates have passed; along axes
    without such plates the box counts as it is.
    """

    quantity: Literal["plate-motion"] = tag("plate-motion")
    methods: ClassVar[tuple[str, ...]] = ("contact-dynamics",)
    drawing, value_label = "path", "displacement into the box"
    units: ClassVar[dict[str, str]] = {"value": "a", "time": "tau", "of": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError without a plate that moves along its normal."""
        if not moved_surfaces(case):
            raise CaseError(
                f"{show(self.quantity)}: no plate moves; expected contact.speed, contact.force or "
                "contact.pressure of a [[wall]]"
            )


@accumulator_of(PlateMotion)
class PlateMotionAccumulator(Samples):
    """Displacements of the plates that move, and the packing fraction, in time."""

    @property
    def width(self) -> int:  # type: ignore[override]
        """Numbers of a sample."""
        return len(moved_surfaces(self.case)) + 1

    def prepare(self) -> None:
        self.which = moved_surfaces(self.case)
        self.names = [surface_names(self.case)[number] for number in self.which]
        super().prepare()

    def observe(self, spheres: RigidEngine) -> None:
        d, shifts = spheres.dimension, spheres.plate_shifts
        filled = ball_volume(d, 1.0) * float((spheres.diameters() ** d).sum())
        room = spheres.room_between_plates
        fraction = filled / float(np.prod(room)) if (room > 0).all() else math.inf
        self.series.add(spheres.time, [*shifts[self.which], fraction])
        self.samples += 1

    def result(self) -> Result:
        """The series, with error bars where four runs or more are pooled."""
        time, rows, errors = self.series.time(), self.series.values(), self.series.error()
        return self.report(
            {"time": time, "of": self.names},
            (rows[:, :-1], errors[:, :-1]),
            self.comparisons(rows, errors),
            samples=self.samples,
        )

    def comparisons(self, rows: Array, errors: Array) -> Iterator[Comparison]:
        """Displacements and packing fraction at the end."""
        if not len(rows):
            return
        for k, name in enumerate(self.names):
            yield Comparison(f"displacement of {name}", rows[-1, k], errors[-1, k], unit="a")
        what = "packing fraction between the plates at the end"
        yield Comparison(what, rows[-1, -1], errors[-1, -1])
