"""Map of the density over two axes."""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.field import Array, Field, FieldAccumulator
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import correlated_error

OPEN = 0.5  # part of a bin that is fluid, for it to count
SPREAD = "root mean square over the map, less what noise adds"


@component
class DensityField(Field):
    """Particles per cell on a grid over two axes."""

    quantity: Literal["density-field"] = tag("density-field")
    drawing = "map"
    value_label = "density"


@accumulator_of(DensityField)
class DensityFieldAccumulator(FieldAccumulator):
    """Density of each bin."""

    def __init__(self, observable: DensityField, case: Case) -> None:
        super().__init__(observable, case, width=1)
        self.bin_volume = np.prod(case.box.size) / np.prod(self.bins)

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        return number[None] / self.bin_volume

    def result(self) -> Result:
        if setting.obstructed(self.case):
            share = solids_of(self.case).open_share(self.axes, self.bins)
            expected = np.where(share > 0, self.case.fluid.density * share, np.nan)
            pressed = setting.driven(self.case)
        else:
            expected = np.full(self.bins, self.case.fluid.density)
            pressed = setting.gathered(self.case) or any(
                setting.uniform_acceleration(self.case)[axis]
                for axis in setting.closed_axes(self.case)
            )
        return self.report(
            self.coordinates,
            (self.blocks.mean()[0], self.blocks.error()[0]),
            self.comparisons(),
            units={"value": self.case.box.density_unit} | dict.fromkeys(self.coordinates, "a"),
            expected=None if pressed else expected,
            theory="uniform",
            extra={
                "bins_per_cell": self.observable.bins_per_cell,
                "dimension": self.case.box.dimension,
            },
        )

    def comparisons(self) -> Iterator[Comparison]:
        if not setting.driven(self.case) or self.blocks.count < 4:
            return
        share = np.ones(self.bins)
        if setting.obstructed(self.case):
            share = solids_of(self.case).open_share(self.axes, self.bins)
        open_bins = share > OPEN
        density, error = (
            a[0][open_bins] / share[open_bins] for a in (self.blocks.mean(), self.blocks.error())
        )
        mean = float(density.mean())
        variance = float(((density - mean) ** 2 - error**2).mean())
        spread = float(np.sqrt(max(variance, 0.0)))
        # what moves the map as a whole, and the noise of squares, which is left without any spread
        gradient = np.zeros(self.blocks.mean().shape)
        gradient[0][open_bins] = 2 * (density - mean) / (share[open_bins] * density.size)
        blocks = of_mean(self.blocks)
        residuals = blocks.residuals.reshape(len(blocks.residuals), -1) @ gradient.ravel()
        moved = float(correlated_error(residuals, blocks.weights))
        off = float(np.hypot(moved, np.sqrt(2 * (error**4).sum()) / density.size))
        off = min(off / (2 * spread), off**0.5) if spread else off**0.5
        values = 100 * spread / mean, 100 * off / mean
        yield Comparison("density spread", *values, unit="%", note=SPREAD)
