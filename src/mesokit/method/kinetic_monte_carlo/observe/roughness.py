"""Roughness of a surface: its width in time, and how fast that grows."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, show, tag
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected import growth_exponent, known_mean, width
from mesokit.method.kinetic_monte_carlo.expected_structure import saturated_width
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.parts import (
    PARTS,
    check_parts,
    in_parts,
    late_exponent,
    of_parts,
)
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import TimeSeries, blocking_error

FLAT = 0.01  # of the last mean square width: a first one below is flat


@component
class Roughness(LatticeObservable):
    """Width of a surface in time, the root mean square of the heights about their mean.

    Its exponent is that of a power of time over the last decade of the run. Errors come from the
    scatter between 16 parts of the lattice, which should be longer than heights are correlated.
    """

    quantity: Literal["roughness"] = tag("roughness")
    drawing, value_label = "growth", "width"
    units: ClassVar[dict[str, str]] = {"time": "tau", "value": "a"}

    def check(self, case: Case) -> None:
        """Raise CaseError for a model without heights, and for a short lattice."""
        super().check(case)
        if case.lattice.model.states():
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has no heights; leave it out"
            )
        check_parts(case)


@accumulator_of(Roughness)
class RoughnessAccumulator(BlockAccumulator):
    """Mean height, and mean square deviations from it in parts of the lattice, in time."""

    memory: ClassVar[tuple[str, ...]] = ("series",)

    def prepare(self) -> None:
        self.series = TimeSeries(1 + PARTS)

    def observe(self, engine: RunningLattice) -> None:
        heights = engine.sites().astype(float)
        mean = heights.mean()
        rows = ((heights - mean) ** 2).reshape(int(self.case.box.size[0]), -1).mean(axis=1)
        self.series.add(engine.time, [mean, *in_parts(rows)])

    def result(self) -> Result:
        time, rows = self.series.time(), self.series.values()
        square, error = of_parts(rows[:, 1:])
        value = np.sqrt(square)
        expected, note = width(self.case, time, float(square[0]) if len(time) else 0.0)
        return self.report(
            {"time": time},
            (value, error / np.where(value > 0, 2 * value, np.inf)),
            self.comparisons(time, rows),
            samples=len(time),
            expected=expected,
            theory=note,
        )

    def comparisons(self, time: NDArray, rows: NDArray) -> Iterator[Comparison]:
        """Speed of growth, exponent and last width."""
        if len(time) < 2:
            return
        speed = (rows[-1, 0] - rows[len(rows) // 2, 0]) / (time[-1] - time[len(rows) // 2])
        known, note = known_mean(self.case, "speed of growth")
        note = f"second half; {note}" if note else "second half"
        yield Comparison("speed of growth", speed, math.nan, known, "1/time", note)
        first, last = rows[0, 1:].mean(), rows[-1, 1:].mean()
        known, note = growth_exponent(self.case)
        if first > FLAT * last:
            known, note = math.nan, "no theory: the first sample is not flat"
        if (found := late_exponent(time, rows[:, 1:], 0.5)) is not None:
            yield Comparison("growth exponent", *found, known, "", note)
        square, errors = of_parts(rows[-1:, 1:])
        expected, note = width(self.case, time[[0, -1]], float(first))
        known = float(expected[1] ** 2) if expected is not None else math.nan
        yield Comparison("last mean square width", square[0], errors[0], known, "a^2", note)
        known, note = saturated_width(self.case)
        if not math.isnan(known):
            squares = rows[:, 1:].mean(axis=1)
            what = "saturated mean square width"
            yield Comparison(what, squares.mean(), blocking_error(squares), known, "a^2", note)
