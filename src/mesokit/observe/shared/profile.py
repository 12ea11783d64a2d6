"""What all profiles along an axis share: bins finer than a cell, and sums in blocks of time."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param
from mesokit.geometry.walls import closed_axes
from mesokit.observe.shared.mode_chi_square import mode_chi_square
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.seam.result import Comparison
from mesokit.statistics import Blocks

Array = NDArray[np.floating[Any]]
KIND = "which of spheres.kinds: name, or number from 1 (all spheres unless said)"


@component
class Profile(Observable):
    """A quantity in slices across an axis."""

    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    axis: Axis = param("y", doc="axis across which the slices lie")
    bins_per_cell: int = param(4, doc="slices per cell, or per length of 1", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not."""
        case.box.index(self.axis)


class Compared(NamedTuple):
    """A profile beside the theory of a method: what is expected in each slice, None without a
    theory; what the theory is called; numbers; the curve of a fit; and what else to store."""

    expected: Array | None
    law: str
    comparisons: list[Comparison]
    fit: Array | None = None
    extra: Mapping[str, Any] = {}


class ProfileAccumulator(BlockAccumulator):
    """Block sums of `width` numbers for each slice."""

    def __init__(self, observable: Profile, case: Case, width: int) -> None:
        self.observable, self.case, self.name = observable, case, observable.label
        self.axis = case.box.index(observable.axis)
        self.bins = max(1, round(case.box.size[self.axis] * observable.bins_per_cell))
        self.axes: tuple[int, ...] = (self.axis,)  # along which sums are in bins
        self.counts: tuple[int, ...] = (self.bins,)
        self.edges = np.linspace(0.0, case.box.size[self.axis], self.bins + 1)
        self.centres = (self.edges[1:] + self.edges[:-1]) / 2
        self.periodic = self.axis not in closed_axes(case)
        self.blocks = Blocks((width, self.bins))
        self.ids: NDArray[np.int64] | None = None  # of particles that count, None if all do

    def observe(self, engine: RunningFluid | RunningSpheres) -> None:
        self.blocks.add(self.sums(engine))

    @abstractmethod
    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        """The (width, *counts) numbers to add up at this moment."""

    def moments(self, engine: RunningFluid | RunningSpheres) -> tuple[Array, Array, Array, Array]:
        """Number, mass, momentum (d, *counts) and sum of m v^2 in the slices."""
        chosen = () if self.ids is None else (self.ids,)
        found: tuple[Array, Array, Array, Array] = engine.moments(self.axes, self.counts, *chosen)
        return found

    def chi_square(self, estimate: Estimate, expected: Array, note: str) -> list[Comparison]:
        """Chi-square of the whole profile per degree of freedom, as a comparison with 1."""
        return mode_chi_square(estimate, expected, self.periodic, note)
