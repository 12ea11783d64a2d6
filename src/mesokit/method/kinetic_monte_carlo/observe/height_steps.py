"""Steps: how heights of neighbouring columns differ."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.kinetic_monte_carlo.expected_structure import height_steps
from mesokit.method.kinetic_monte_carlo.observe.height_differences import check_heights
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.neighbours import Neighbours
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

MOST = 16  # atoms: higher steps count in the mean square alone


@component
class HeightSteps(LatticeObservable):
    """Probability of a step dh between neighbouring columns, up to 16 atoms."""

    quantity: Literal["height-steps"] = tag("height-steps")
    drawing, value_label = "histogram", "probability of a step"
    units: ClassVar[dict[str, str]] = {"dh": "a"}

    def check(self, case: Case) -> None:
        """Raise CaseError for a model without heights."""
        super().check(case)
        check_heights(case)


@accumulator_of(HeightSteps)
class HeightStepsAccumulator(BlockAccumulator):
    """Parts of the pairs with each step, and the mean square of all steps."""

    def prepare(self) -> None:
        self.neighbours = Neighbours(self.case)
        self.blocks = Blocks(2 * MOST + 2)

    def observe(self, engine: RunningLattice) -> None:
        heights = engine.sites().astype(np.int64).reshape(self.neighbours.size)
        found = np.zeros(2 * MOST + 2)
        pairs = 0
        for there, counts in self.neighbours.pairs(heights):
            steps = (there - heights)[counts]
            inside = steps[abs(steps) <= MOST] + MOST
            found[:-1] += np.bincount(inside, minlength=2 * MOST + 1)
            found[-1] += float((steps**2).sum())
            pairs += len(steps)
        self.blocks.add(found / pairs)

    def result(self) -> Result:
        step = np.arange(-MOST, MOST + 1.0)
        mean, error = self.blocks.mean()[:-1], self.blocks.error()[:-1]
        seen = max(3, int(abs(step[mean > 0]).max(initial=0)) + 2)
        use = abs(step) <= seen
        expected, square, note = height_steps(self.case, step)
        return self.report(
            {"dh": step[use]},
            (mean[use], error[use]),
            self.comparisons(expected, square, note),
            expected=None if expected is None else expected[use],
            theory=note,
            extra={
                "edges": np.append(step[use] - 0.5, step[use][-1] + 0.5),
                "of": "step",
                "discrete": True,
            },
        )

    def comparisons(self, expected: Array | None, square: float, note: str) -> Iterator[Comparison]:
        """The part of the pairs without a step, and the mean square step."""
        means, unit = of_mean(self.blocks), np.eye(2 * MOST + 2)
        known = np.nan if expected is None else float(expected[MOST])
        yield Comparison("pairs without a step", *means.total(unit[MOST]), known, "", note)
        yield Comparison("mean square step", *means.total(unit[-1]), square, "a^2", note)
