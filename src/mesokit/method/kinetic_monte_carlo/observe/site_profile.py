"""Profile of the states of sites along an axis."""

from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import Blocks


@component
class SiteProfile(LatticeObservable):
    """Part of the sites in each state along an axis, or the mean height, averaged over time."""

    quantity: Literal["site-profile"] = tag("site-profile")
    axis: Literal["x", "y", "z"] = param("x", doc="axis along which it is")
    value_label = "part of the sites"

    def check(self, case: Case) -> None:
        """Raise CaseError for an axis that the box has not."""
        super().check(case)
        case.box.index(self.axis)


@accumulator_of(SiteProfile)
class SiteProfileAccumulator(BlockAccumulator):
    """Parts of the sites at each place along the axis."""

    memory: ClassVar[tuple[str, ...]] = ("blocks",)
    observable: SiteProfile

    def prepare(self) -> None:
        self.names = self.case.lattice.model.states()
        self.size = tuple(map(int, self.case.box.size))
        self.along = self.case.box.index(self.observable.axis)
        length = self.size[self.along]
        self.blocks = Blocks((length, len(self.names)) if self.names else (length,))

    def observe(self, engine: RunningLattice) -> None:
        sites = engine.sites().reshape(self.size)
        rows = np.moveaxis(sites, self.along, 0).reshape(self.size[self.along], -1)
        if self.names:
            parts = [(rows == k).mean(axis=1) for k in range(len(self.names))]
            self.blocks.add(np.stack(parts, axis=1))
        else:
            self.blocks.add(rows.mean(axis=1))

    def result(self) -> Result:
        place = np.arange(self.size[self.along]) + 0.5
        x: dict[str, Any] = {self.observable.axis: place}
        if self.names:
            x["state"] = np.array(self.names)
        label = "part of the sites" if self.names else "height"
        return self.report(x, self.blocks, label=label)
