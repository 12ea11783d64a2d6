"""Number of particles in cells: a histogram beside Poisson's."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import free_volume, solids_of
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared import chi_square
from mesokit.seam.engine import RunningFluid, Some, Terms
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

FEWEST = 20  # cells
REACH = 6.0  # standard deviations of the numbers that have a bin of their own


@component
class CellOccupancy(Observable):
    """Histogram of the number of particles in cells of a lattice at rest.

    Cells in a solid, or cut by one, do not count. An ideal gas has Poisson numbers; the chi-square
    of single samples has a known mean, which no memory from one sample to the next changes.
    """

    quantity: Literal["cell-occupancy"] = tag("cell-occupancy")
    drawing = "histograms"
    value_label = "probability"
    units: ClassVar[dict[str, str]] = {"of": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError with too few whole cells."""
        if (number := int(_whole_cells(case).sum())) < FEWEST:
            raise CaseError(f"{number} whole cells in the fluid; expected at least {FEWEST}")


@accumulator_of(CellOccupancy)
class CellOccupancyAccumulator(BlockAccumulator):
    """Block averages of the shares of the cells, and of mean, variance and chi-square."""

    def prepare(self) -> None:
        case = self.case
        from scipy.stats import poisson

        self.cells, mean = _whole_cells(case).ravel(), case.fluid.density
        self.first = max(0, math.floor(mean - REACH * math.sqrt(mean)))
        last = math.ceil(mean + REACH * math.sqrt(mean) + 2)
        self.numbers = np.arange(self.first, last + 1)
        self.probability = poisson.pmf(self.numbers, mean)
        self.whole = self.probability.copy()  # with the tails in the first and last bin
        self.whole[0] = poisson.cdf(self.numbers[0], mean)
        self.whole[-1] = poisson.sf(self.numbers[-1] - 1, mean)
        self.of = chi_square.classes(self.whole, int(self.cells.sum()))
        self.classes = chi_square.joined(self.whole, self.of)
        self.blocks = Blocks((len(self.numbers) + 3,))

    def observe(self, fluid: RunningFluid) -> None:
        (number,) = fluid.sums_of_particles(self.cell_of, len(self.cells), [1.0])
        held = number.astype(np.int64)[self.cells]
        bins = np.clip(held - self.first, 0, len(self.numbers) - 1)
        count = np.bincount(bins, minlength=len(self.numbers)).astype(float)
        square = chi_square.chi_square(chi_square.joined(count, self.of), self.classes)
        self.blocks.add(np.append(count / len(held), [held.mean(), held.var(), square]))

    def cell_of(self, some: Some) -> Terms:
        """Cells of some particles, each of which counts as one."""
        size, place = self.case.box.size, np.floor(some.positions).astype(np.int64)
        for k, length in enumerate(size):  # what lies at the very end is in the last
            place[:, k] = np.clip(place[:, k], 0, length - 1)
        return np.ravel_multi_index(tuple(place.T), size), [np.ones(len(place))]

    def result(self) -> Result:
        mean, error = self.blocks.mean(), self.blocks.error()
        known = self._even()
        expected = self.probability if known else np.full(len(self.numbers), np.nan)
        return self.report(
            {"of": ["number"], "bin": self.numbers},
            (mean[None, :-3], error[None, :-3]),
            list(self._comparisons(mean[-3:], error[-3:])),
            expected=expected[None],
            theory="Poisson",
            extra={"edges": (np.append(self.numbers, self.numbers[-1] + 1) - 0.5)[None]},
        )

    def _even(self) -> bool:
        """Whether the fluid is an ideal gas of the same density everywhere."""
        case = self.case
        pressed = setting.uniform_acceleration(case)[sorted(setting.closed_axes(case))]
        return case.fluid.molecule is None and not (setting.gathered(case) or pressed.any())

    def _comparisons(self, mean: Array, error: Array) -> Iterator[Comparison]:
        case, number, note = self.case, int(self.cells.sum()), ""
        if not self._even():
            note = "no theory of such a fluid"
        elif setting.obstructed(case) and setting.driven(case):
            note = "approximate: the flow makes the density uneven"
        # the number of all particles is fixed: of each class, its covariance with the number
        density, known = case.fluid.density, self._even()
        away = chi_square.joined(self.whole * (self.numbers - density), self.of)
        part = number / free_volume(case)
        lost = part * chi_square.taken(away / math.sqrt(density), self.classes)
        what, spread = "variance of the number over its mean", error[1] / mean[0]
        # about the mean of the sample, whatever others hold
        expected = 1.0 - 1.0 / number if known else math.nan
        yield Comparison(what, mean[1] / mean[0], spread, expected, "", note)
        expected = len(self.classes) - 1.0 - lost if known else math.nan
        note = note or f"Poisson, {len(self.classes)} classes"
        yield Comparison("mean chi-square of the number", mean[2], error[2], expected, "", note)


def _whole_cells(case: Case) -> NDArray[np.bool_]:
    """Which cells of the lattice at rest are fluid all over."""
    centres = np.stack(
        np.meshgrid(*(np.arange(n) + 0.5 for n in case.box.size), indexing="ij"), axis=-1
    )
    if not setting.obstructed(case):
        return np.ones(case.box.size, bool)
    half = 0.5 * math.sqrt(case.box.dimension)
    clear = solids_of(case).distance(centres.reshape(-1, case.box.dimension)) > half
    return np.asarray(clear.reshape(case.box.size))
