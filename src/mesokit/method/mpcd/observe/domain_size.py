"""Size of the domains of two species in time."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.observe.shared.periodic import periodic_all_over
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import TimeSeries

ROWS = 4096  # kept of the series in time
CLEAR = 10.0  # standard deviations of noise above which there are domains at all
LATE = 0.1  # part of the series that gives the size at the end


@component
class DomainSize(Observable):
    """Size of the domains of two species: 2 pi over the mean wave number of the colour.

    The colour is the number of particles of one species less that of the other. Its structure
    factor S(k), without the noise of independent particles (1), weighs the wave numbers
    (first moment). A band of half of a box reads three quarters of it, for its edges. nan as
    long as there are no domains.
    """

    quantity: Literal["domain-size"] = tag("domain-size")
    value_label = "size of domains"
    units: ClassVar[dict[str, str]] = {"value": "a", "time": "tau"}
    largest: float = param(
        math.pi / 2, doc="longest wave vector that counts", unit="1/a", gt=0, le=math.pi
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without two species, and where waves do not fit."""
        if len(case.fluid.species) != 2:
            raise CaseError(f"domain-size: {len(case.fluid.species)} fluid.species; expected 2")
        periodic_all_over(case, "domain-size")
        least = 2 * math.pi / max(case.box.size)
        if self.largest < least:
            raise CaseError(
                f"largest = {self.largest:g}: expected {least:.4g} (one wave in the box) or more"
            )


@accumulator_of(DomainSize)
class DomainSizeAccumulator(BlockAccumulator):
    """The series in time."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples")
    added: ClassVar[tuple[str, ...]] = ("samples",)

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.size = case.box.size
        first, second = (kind.number for kind in case.groups[0].kinds)
        self.first, mean = first, (first - second) / (first + second)
        self.colours = 1.0 - mean, -1.0 - mean  # of one of either species, 0 in the mean
        self.noise = first * self.colours[0] ** 2 + second * self.colours[1] ** 2
        # waves of cells: with the real transform those along the last axis stand for two but
        # for the first and the last
        turns = [np.fft.fftfreq(n) for n in self.size[:-1]] + [np.fft.rfftfreq(self.size[-1])]
        grids = np.meshgrid(*turns, indexing="ij")
        length = 2 * math.pi * np.sqrt(sum(grid**2 for grid in grids))
        self.counts = (length > 0) & (length <= observable.largest)
        alone = (grids[-1] == 0) | (2 * grids[-1] == 1)
        self.lengths = length[self.counts]
        # a cell is a mean over its side
        smeared = np.prod([np.sinc(grid) ** 2 for grid in grids], axis=0)
        self.weights = (np.where(alone, 1.0, 2.0) / smeared)[self.counts]
        self.series, self.samples = TimeSeries(1, ROWS), np.zeros(1, np.int64)

    def observe(self, fluid: RunningFluid) -> None:
        (colour,) = fluid.sums_of_particles(self.colour_of, math.prod(self.size), [1.0])
        power = abs(np.fft.rfftn(colour.reshape(self.size))[self.counts]) ** 2 / self.noise
        self.series.add(fluid.time, [self.size_of(power)])
        self.samples += 1

    def colour_of(self, some: Some) -> Terms:
        """Cells of some particles, and their colour."""
        cell = np.floor(some.positions).astype(int) % np.array(self.size)
        place = np.ravel_multi_index(tuple(cell.T), self.size)
        return place, [np.where(some.ids < self.first, *self.colours)]

    def size_of(self, power: Array) -> float:
        """Of the structure factor of each wave, noise included."""
        weight = self.weights * (power - 1.0)
        if weight.sum() < CLEAR * np.sqrt((self.weights**2).sum()):
            return math.nan
        return float(2 * math.pi * weight.sum() / (weight @ self.lengths))

    def result(self) -> Result:
        value = self.series.values()[:, 0]
        return self.report(
            {"time": self.series.time()},
            value,
            self.comparisons(value),
            samples=int(self.samples[0]),
            extra={"samples_per_row": self.series.stride},
        )

    def comparisons(self, value: Array) -> Iterator[Comparison]:
        late = value[-max(2, math.ceil(LATE * len(value))) :]
        if len(late) < 2:
            return
        note = "mean and scatter of the last tenth"
        mean, scatter = float(late.mean()), float(late.std(ddof=1))
        yield Comparison("size of domains at the end", mean, scatter, math.nan, "a", note)
