"""Base classes of observables of spheres and of the series that they keep in time."""

from typing import ClassVar

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.statistics import TimeSeries


@component
class OfSpheres(Observable):
    """Something measured of disks and spheres."""

    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres", "contact-dynamics")
    of_methods_alone: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False


class Samples(BlockAccumulator):
    """Rows of `width` numbers in time, and the number of samples."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples")
    added: ClassVar[tuple[str, ...]] = ("samples",)
    width: ClassVar[int]

    def prepare(self) -> None:
        self.series, self.samples = TimeSeries(self.width), 0


def gravity_axis(case: Case, quantity: str) -> int:
    """The axis of gravity. Raises CaseError unless there is one axis, which plates close."""
    along = np.flatnonzero(case.spheres.gravity)
    if len(along) != 1 or int(along[0]) not in closed_axes(case):
        raise CaseError(f"{quantity}: expected gravity along one axis, which plates close")
    return int(along[0])
