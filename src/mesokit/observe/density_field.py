"""Map of the density over two axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from mesokit.case.component import component, tag
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.field import Array, Field, FieldAccumulator
from mesokit.observe.shared.result import Result

if TYPE_CHECKING:
    from mesokit.case.case import Case


@component
class DensityField(Field):
    """Particles per cell on a grid over two axes."""

    quantity: Literal["density-field"] = tag("density-field")

    def accumulator(self, case: Case) -> DensityFieldAccumulator:
        """An empty memory for it."""
        return DensityFieldAccumulator(self, case)


class DensityFieldAccumulator(FieldAccumulator):
    """Density of each bin."""

    def __init__(self, observable: DensityField, case: Case) -> None:
        super().__init__(observable, case, width=1)
        self.bin_volume = np.prod(case.box.size) / np.prod(self.bins)

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Particles per volume."""
        return number[None] / self.bin_volume

    def result(self) -> Result:
        """The map; uniform unless a force presses the fluid to a plate."""
        if setting.obstructed(self.case):
            share = solids_of(self.case).open_share(self.axes, self.bins)
            expected = np.where(share > 0, self.case.fluid.density * share, np.nan)
            pressed = setting.driven(self.case)
        else:
            expected = np.full(self.bins, self.case.fluid.density)
            pressed = setting.gathered(self.case) or any(
                setting.acceleration(self.case)[axis] for axis in setting.closed_axes(self.case)
            )
        return Result(
            quantity="density-field",
            drawing="map",
            name=self.name,
            x=self.coordinates,
            value=self.blocks.mean()[0],
            error=self.blocks.error()[0],
            label="density",
            units={"value": self.case.box.density_unit} | dict.fromkeys(self.coordinates, "a"),
            expected=None if pressed else expected,
            theory="uniform",
            samples=self.blocks.count,
            extra={
                "bins_per_cell": self.observable.bins_per_cell,
                "dimension": self.case.box.dimension,
            },
        )
