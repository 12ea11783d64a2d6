"""What all profiles along an axis share: bins finer than a cell, and sums in blocks of time."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import Axis
from mesokit.case.component import component, name_of, param
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.mode_chi_square import mode_chi_square
from mesokit.seam.estimate import Estimate
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.seam.result import Comparison
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case

Array = NDArray[np.floating[Any]]


@component
class Profile(Observable):
    """A quantity in slices across an axis."""

    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    axis: Axis = param("y", doc="axis across which the slices lie")
    bins_per_cell: int = param(4, doc="slices per cell, or per length of 1", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not."""
        case.box.index(self.axis)


def expected_in_slices(case: Case, observable: Profile) -> Any:
    """What a method of spheres says of a profile; None of a fluid, which says it elsewhere."""
    found = method_of(case).expected.get(name_of(observable))
    return None if found is None else found(case, observable)


class ProfileAccumulator(BlockAccumulator):
    """Block sums of `width` numbers for each slice."""

    def __init__(self, observable: Profile, case: Case, width: int) -> None:
        observable.check(case)
        self.observable, self.case, self.name = observable, case, observable.label
        self.axis = case.box.index(observable.axis)
        self.bins = max(1, round(case.box.size[self.axis] * observable.bins_per_cell))
        self.axes: tuple[int, ...] = (self.axis,)  # along which sums are in bins
        self.counts: tuple[int, ...] = (self.bins,)
        self.edges = np.linspace(0.0, case.box.size[self.axis], self.bins + 1)
        self.centres = (self.edges[1:] + self.edges[:-1]) / 2
        self.periodic = self.axis not in setting.closed_axes(case)
        self.blocks = Blocks((width, self.bins))
        self.ids: NDArray[np.int64] | None = None  # of spheres that count, where not all do

    def observe(self, fluid: Any) -> None:
        """Take one sample."""
        chosen = () if self.ids is None else (self.ids,)
        self.blocks.add(self.sample(*fluid.moments(self.axes, self.counts, *chosen)))

    @abstractmethod
    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """The (width, *counts) numbers to add up."""

    def chi_square(self, estimate: Estimate, expected: Array, note: str) -> list[Comparison]:
        """Chi-square of the whole profile per degree of freedom, as a comparison with 1."""
        return mode_chi_square(estimate, expected, self.periodic, note)


def part_of(estimate: Estimate, chosen: NDArray[np.bool_]) -> Estimate:
    """Some slices of a profile."""
    weights = estimate.weights if estimate.weights.ndim == 1 else estimate.weights[:, chosen]
    return Estimate(estimate.value[chosen], estimate.residuals[:, chosen], weights)
