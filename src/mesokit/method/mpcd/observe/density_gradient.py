"""Density of the fluid along the flow, over a unit cell of what it flows round."""

from collections.abc import Iterator
from typing import Literal

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import solids_of
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.compression import compression, unit_cell
from mesokit.method.mpcd.expected.ideal import flow_axis
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate, noted, of_mean
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

OPEN = 0.1  # part of a slice that is fluid, for it to count


@component
class DensityGradient(Observable):
    """Particles per volume of fluid in slices along the flow, all unit cells taken together.

    A force presses an ideal gas, which this fluid is, against what holds it up: the density rises
    before obstacles and falls behind them. That is wanted small: a real liquid hardly does so.
    """

    quantity: Literal["density-gradient"] = tag("density-gradient")
    drawing = "profile"
    value_label = "density"
    axis: Axis | None = param(
        None, doc="the axis (that of the force on the fluid, x unless there is one)"
    )
    length: float | None = param(
        None,
        doc="of a unit cell, a whole part of the box (that of arrays, else the box, unless said)",
        unit="a",
        gt=0,
    )
    bins_per_cell: int = param(1, doc="slices per cell", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for a closed axis, and a length that does not divide the box."""
        axis, length, repeats = self.unit_cells(case)
        if axis in setting.closed_axes(case):
            raise CaseError(f"axis = {AXES[axis]!r}: plates close it; for that see density-profile")
        for number, key, given in (
            (repeats, "length", length),
            (length * self.bins_per_cell, "bins_per_cell", self.bins_per_cell),
        ):
            if abs(number - round(number)) > 1e-9 * number or round(number) < 1:
                raise CaseError(
                    f"{key} = {given:g}: expected whole numbers of unit cells in the box "
                    f"({case.box.size[axis]:g}), and of slices in a unit cell "
                    f"({length:g} long)"
                )

    def unit_cells(self, case: Case) -> tuple[int, float, float]:
        """Number of the axis, length of a unit cell, and number of unit cells in the box."""
        axis = flow_axis(case, self.axis)
        length = self.length or unit_cell(case, axis)
        return axis, length, float(case.box.size[axis]) / length


@accumulator_of(DensityGradient)
class DensityGradientAccumulator(BlockAccumulator):
    """Particles in each slice of a unit cell."""

    def prepare(self) -> None:
        self.axis, self.length, repeats = self.observable.unit_cells(self.case)
        self.repeats = round(repeats)
        self.slices = round(self.length * self.observable.bins_per_cell)
        self.bins = self.slices * self.repeats
        self.blocks = Blocks((self.slices,))

    def observe(self, fluid: RunningFluid) -> None:
        number = fluid.moments((self.axis,), (self.bins,))[0]
        self.blocks.add(number.reshape(self.repeats, self.slices).sum(axis=0))

    def volume(self) -> Array:
        """Of the fluid in each slice (slices,), in all unit cells."""
        share = np.ones(self.bins)
        if setting.obstructed(self.case):
            share = solids_of(self.case).open_share((self.axis,), (self.bins,))
        whole = self.case.box.volume / self.bins
        return np.asarray(whole * share.reshape(self.repeats, self.slices).sum(axis=0))

    def result(self) -> Result:
        volume, every = self.volume(), of_mean(self.blocks)
        seen = volume > OPEN * volume.max()
        scale = np.where(seen, 1 / np.where(seen, volume, 1.0), np.nan)
        axis, unit = AXES[self.axis], self.case.box.density_unit
        density = Estimate(every.value * scale, every.residuals * scale, every.weights)
        mean = every.value.sum() / volume.sum()
        pressed, known = (
            setting.gathered(self.case) or setting.driven(self.case),
            compression(self.case),
        )
        error = density.error if self.blocks.count else np.full(self.slices, np.nan)
        return self.report(
            {axis: (np.arange(self.slices) + 0.5) * self.length / self.slices},
            (density.value, error),
            self.comparisons(density, mean, seen),
            units={"value": unit, axis: "a"},
            expected=None if pressed else np.where(seen, mean, np.nan),
            theory="uniform",
            extra={
                "bins_per_cell": self.observable.bins_per_cell,
                "length": self.length,
                "acceleration_length_over_kT": known[1] if known else 0.0,
            },
        )

    def comparisons(self, density: Estimate, mean: float, seen: Array) -> Iterator[Comparison]:
        known = compression(self.case)
        said = f"acceleration x length/(kT/m) is {known[1]:.2g}" if known else ""
        place = 2 * np.pi * (np.arange(self.slices) + 0.5) / self.slices
        waves = 2 / max(seen.sum(), 1) * np.stack([np.cos(place), np.sin(place)]) * seen
        filled = Estimate(
            np.where(seen, density.value - mean, 0.0),
            np.where(seen, density.residuals, 0.0),
            density.weights,
        )
        wave = filled.linear(waves / mean)
        size = float(np.hypot(*wave.value))
        along = wave.value / size if size > 0 else np.array([1.0, 0.0])
        value, error = wave.scalar(100 * size, 100 * along)
        # an amplitude is never below zero, so that it is not compared with it
        note = said or "noise alone reads about 1.3 standard errors"
        yield Comparison("amplitude of the density", value, error, unit="%", note=note)
        value_of = np.where(seen, density.value, np.nan)
        high, low = int(np.nanargmax(value_of)), int(np.nanargmin(value_of))
        top, bottom = float(value_of[high]), float(value_of[low])
        if bottom > 0:
            slope = np.zeros(self.slices)
            slope[high] += 1 / bottom
            slope[low] -= top / bottom**2
            what, smallest = "largest density over smallest", np.eye(self.slices)[low]
            value, error = filled.scalar(top / bottom, slope, over=(bottom, smallest))
            yield Comparison(what, value, error, note=noted(value, said))
