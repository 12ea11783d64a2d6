"""Angle of the free surface of a heap of grains."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.method.spheres.common.observe.shared.bed_surface import heights_of, horizontal
from mesokit.seam.engine import Integers, RunningSpheres
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks, TimeSeries

FLANK = 0.2, 0.8  # of the height of the heap: its foot and its top are round
FEWEST = 4  # cells of a flank
ACROSS = 2.0  # mean diameters: cells of a ridge along its crest
SECTORS = 4  # of a cone
LATE = 0.25  # of the samples
PIECES = 40  # points of the figure


@component
class ReposeAngle(OfSpheres):
    """Angle of the flanks of a heap against the horizontal, in time and at the end.

    The surface is the highest point of the grains in each cell. A line through the flank between a
    fifth and four fifths of the height has the median of the slopes of all pairs of cells (Theil
    1950; Sen 1968). The error bar is the scatter of the flanks: two, or four sectors of a cone.
    """

    quantity: Literal["repose-angle"] = tag("repose-angle")
    value_label = "angle of the flanks"
    units: ClassVar[dict[str, str]] = {"value": "degrees", "time": "tau"}
    shape: Literal["ridge", "cone"] | None = param(
        None, doc="of the heap: a ridge in 2D, else a cone, unless said"
    )
    axis: Axis | None = param(
        None, doc="axis across the ridge (the first horizontal one unless said)"
    )
    cell: float | None = param(
        None, doc="width of a cell (the mean diameter unless said)", unit="a", gt=0
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without gravity along one axis, and for a cone in 2D."""
        horizontal(case, self.axis, "repose-angle")
        if self.shape == "cone" and case.box.dimension == 2:
            raise CaseError(f"shape = {show(self.shape)}: expected 'ridge' in 2D")
        if self.round(case) and self.axis is not None:
            raise CaseError(f"axis = {show(self.axis)}: no effect on a cone")

    def round(self, case: Case) -> bool:
        """Whether the heap is a cone."""
        return self.shape == "cone" or (self.shape is None and case.box.dimension == 3)


@accumulator_of(ReposeAngle)
class ReposeAngleAccumulator(BlockAccumulator):
    """Angles of the flanks in time, nan where one has too few cells, and blocks of their mean."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series", "samples")
    added: ClassVar[tuple[str, ...]] = ("samples",)

    def prepare(self) -> None:
        self.pull, self.along = horizontal(self.case, self.observable.axis, "repose-angle")
        self.round = self.observable.round(self.case)
        self.blocks, self.samples = Blocks(), 0
        self.series = TimeSeries(SECTORS if self.round else 2)

    def observe(self, spheres: RunningSpheres) -> None:
        places, diameters = spheres.positions(unwrapped=True), spheres.diameters()
        top = heights_of(self.case, spheres, self.pull) + 0.5 * diameters
        cell = self.observable.cell or float(diameters.mean())
        others = [k for k in range(spheres.dimension) if k != self.pull]
        if self.round:
            angles = self.of_cone(places[:, others], top, spheres.masses(), cell)
        else:
            third = [k for k in others if k != self.along]
            strip = np.zeros(len(top), np.int64)
            if third:
                wide = ACROSS * float(diameters.mean())
                strip = np.floor(places[:, third[0]] / wide).astype(np.int64)
            angles = self.of_ridge(places[:, self.along], strip, top, cell)
        self.series.add(spheres.time, angles)
        self.samples += 1
        if np.isfinite(angles).any():
            self.blocks.add(np.nanmean(angles))

    def of_ridge(self, x: Array, strip: Integers, top: Array, cell: float) -> list[float]:
        """Angles of both flanks; heights are means over the cells along the crest."""
        column = np.floor(x / cell).astype(np.int64)
        at, heights = highest(column, strip, top)
        x, crest = (at + 0.5) * cell, int(heights.argmax())
        left, right = slice(None, crest + 1), slice(crest, None)
        return [angle(x[part], heights[part], heights.max()) for part in (left, right)]

    def of_cone(self, places: Array, top: Array, masses: Array, cell: float) -> list[float]:
        """Angles of four sectors about the middle."""
        away = places - np.average(places, axis=0, weights=masses)
        ring = np.floor(np.linalg.norm(away, axis=1) / cell).astype(np.int64)
        turn = np.arctan2(away[:, 1], away[:, 0]) / (2 * math.pi) + 0.5
        sector, found = np.minimum((SECTORS * turn).astype(np.int64), SECTORS - 1), []
        for k in range(SECTORS):
            mine = sector == k
            if not mine.any():
                found.append(math.nan)
                continue
            at, heights = highest(ring[mine], np.zeros(int(mine.sum()), np.int64), top[mine])
            found.append(angle((at + 0.5) * cell, heights, float(top.max())))
        return found

    def result(self) -> Result:
        """The mean angle in time, and that at the end."""
        each, time = self.series.each(), self.series.time()  # (runs, n, flanks)
        runs, samples, number = each.shape
        flanks = each.transpose(0, 2, 1).reshape(runs * number, samples)
        parts = np.array_split(np.arange(len(time)), max(1, min(PIECES, len(time))))
        pieces = [scatter(mean_of(flanks[:, part])) for part in parts if len(part)]
        value, error = np.reshape(pieces, (-1, 2)).T
        return self.report(
            {"time": np.array([time[part].mean() for part in parts if len(part)])},
            (value, error),
            self.comparisons(flanks),
            samples=self.samples,
        )

    def comparisons(self, flanks: Array) -> Iterator[Comparison]:
        """The angle at the end, of the last quarter of the samples, and the mean of all."""
        last = mean_of(flanks[:, -max(1, math.ceil(LATE * flanks.shape[1])) :])
        value, error = scatter(last)
        note = "no flank has four cells or more" if math.isnan(value) else ""
        yield Comparison("angle at the end", value, error, unit="degrees", note=note)
        mean = float(self.blocks.mean()), float(self.blocks.error())
        yield Comparison("mean angle", *mean, unit="degrees")


def highest(column: Integers, strip: Integers, top: Array) -> tuple[Integers, Array]:
    """Columns that have grains, in order, and the mean over their strips of the highest point.

    >>> highest(np.array([3, 3, 1]), np.array([0, 0, 0]), np.array([2.0, 5.0, 1.0]))
    (array([1, 3]), array([1., 5.]))
    """
    low, width = int(strip.min()), int(strip.max() - strip.min()) + 1
    cells, place = np.unique(column * width + strip - low, return_inverse=True)
    peaks = np.full(len(cells), -np.inf)
    np.maximum.at(peaks, place, top)
    columns, of = np.unique(cells // width, return_inverse=True)
    return columns, np.bincount(of, peaks) / np.bincount(of)


def angle(x: Array, heights: Array, peak: float) -> float:
    """Angle in degrees of the part of a flank between two shares of the height; nan of less than
    four cells.

    >>> x = np.arange(20.0)
    >>> round(angle(x, 20 - x, 20.0), 6)
    45.0
    """
    use = (heights >= FLANK[0] * peak) & (heights <= FLANK[1] * peak)
    if use.sum() < FEWEST:
        return math.nan
    first, second = np.triu_indices(int(use.sum()), 1)
    x, heights = x[use], heights[use]
    slopes = (heights[second] - heights[first]) / (x[second] - x[first])
    return math.degrees(math.atan(abs(float(np.median(slopes)))))


def mean_of(rows: Array) -> Array:
    """Means of rows (n, m) over what is known of each; nan where nothing is."""
    known = np.isfinite(rows)
    count = known.sum(axis=1)
    total = np.where(known, rows, 0.0).sum(axis=1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def scatter(numbers: Array) -> tuple[float, float]:
    """Mean of the numbers that are known, and its standard error by how these scatter."""
    known = numbers[np.isfinite(numbers)]
    if not len(known):
        return math.nan, math.nan
    spread = float(known.std(ddof=1)) / math.sqrt(len(known)) if len(known) > 1 else math.nan
    return float(known.mean()), spread
