"""Maps over two axes, with sums in few blocks of time, for a map has many bins."""

from abc import abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param
from mesokit.errors import CaseError
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.statistics import Blocks

Array = NDArray[np.floating[Any]]
CAPACITY = 16  # blocks


@component
class Field(Observable):
    """A quantity on a grid over two axes, averaged along the third."""

    axes: tuple[Axis, Axis] = param(("x", "y"), doc="the two axes of the map")
    bins_per_cell: int = param(1, doc="bins per cell along each axis", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, or twice the same."""
        for axis in self.axes:
            case.box.index(axis, "axes")
        if self.axes[0] == self.axes[1]:
            raise CaseError(f"axes = {list(self.axes)}: expected two different axes")


class FieldAccumulator(BlockAccumulator):
    """Block sums of `width` numbers for each bin."""

    def __init__(self, observable: Field, case: Case, width: int) -> None:
        self.observable, self.case, self.name = observable, case, observable.label
        self.axes = tuple(case.box.index(axis) for axis in observable.axes)
        self.bins = tuple(
            max(1, round(case.box.size[a] * observable.bins_per_cell)) for a in self.axes
        )
        self.edges = [
            np.linspace(0.0, case.box.size[a], n + 1)
            for a, n in zip(self.axes, self.bins, strict=True)
        ]
        self.coordinates: dict[str, Array] = {
            str(name): (e[1:] + e[:-1]) / 2
            for name, e in zip(observable.axes, self.edges, strict=True)
        }
        self.blocks = Blocks((width, *self.bins), capacity=CAPACITY)

    def observe(self, fluid: RunningFluid) -> None:
        self.blocks.add(self.sample(*fluid.moments(self.axes, self.bins)))

    @abstractmethod
    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """The (width, *bins) numbers to add up."""
