"""Profiles along an axis: bins finer than a cell, and sums in blocks of time."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param
from mesokit.geometry.walls import closed_axes
from mesokit.observe.shared.mode_chi_square import mode_chi_square
from mesokit.observe.shared.of_method import OfMethod
from mesokit.seam.engine import RunningFluid, RunningSpheres
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import BlockAccumulator
from mesokit.seam.result import Comparison, Result

Array = NDArray[np.floating[Any]]
KIND = "which of spheres.kinds: name, or number from 1 (all spheres unless said)"


@component
class Profile(OfMethod):
    """A quantity in slices across an axis."""

    drawing = "profile"
    axis: Axis = param("y", doc="axis across which the slices lie")
    bins_per_cell: int = param(4, doc="slices per cell, or per length of 1", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not, and without anything to measure."""
        case.box.index(self.axis)
        self.theory(case)


class Compared(NamedTuple):
    """A profile beside the theory of a method: what is expected in each slice, None without a
    theory; what the theory is called; numbers; the curve of a fit; and what else to store."""

    expected: Array | None
    law: str
    comparisons: list[Comparison]
    fit: Array | None = None
    extra: Mapping[str, Any] = {}


class ProfileAccumulator(BlockAccumulator):
    """Block sums of numbers for each slice; a subclass makes the blocks."""

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.theory = observable.theory(case)
        self.ids: NDArray[np.int64] | None = self.theory.ids  # particles that count, None: all
        self.axis = case.box.index(observable.axis)
        length = case.box.size[self.axis]
        self.bins = max(1, round(length * observable.bins_per_cell))
        self.axes: tuple[int, ...] = (self.axis,)  # along which sums are in bins
        self.counts: tuple[int, ...] = (self.bins,)
        self.edges = np.linspace(0.0, length, self.bins + 1)
        self.centres = (self.edges[1:] + self.edges[:-1]) / 2
        self.periodic = self.axis not in closed_axes(case)

    def observe(self, engine: RunningFluid | RunningSpheres) -> None:
        self.blocks.add(self.sums(engine))

    @abstractmethod
    def sums(self, engine: RunningFluid | RunningSpheres) -> Array:
        """The (numbers, *counts) to add up at this moment."""

    def moments(self, engine: RunningFluid | RunningSpheres) -> tuple[Array, Array, Array, Array]:
        """Number, mass, momentum (d, *counts) and sum of m v^2 in the slices."""
        chosen = () if self.ids is None else (self.ids,)
        found: tuple[Array, Array, Array, Array] = engine.moments(self.axes, self.counts, *chosen)
        return found

    def chi_square(self, estimate: Estimate, expected: Array, note: str) -> list[Comparison]:
        """Chi-square of the whole profile per degree of freedom, as a comparison with 1."""
        return mode_chi_square(estimate, expected, self.periodic, note)

    def in_slices(
        self, found: Estimate | tuple[Array, Array], known: Compared, unit: str, **more: Any
    ) -> Result:
        """The result of values (bins,) of a unit, beside theory."""
        axis, extra = self.observable.axis, {"bins_per_cell": self.observable.bins_per_cell}
        return self.report(
            {axis: self.centres},
            found,
            known.comparisons,
            units={"value": unit, axis: "a"},
            expected=known.expected,
            fit=known.fit,
            theory=known.law,
            extra=extra | more.pop("extra", {}) | dict(known.extra),
            **more,
        )
