"""Whether a flow had built up when samples were taken: else its mean is not that of theory."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, NamedTuple

from mesokit.method.protocol import method_of
from mesokit.observe.shared.protocol import Accumulator
from mesokit.observe.shared.result import NOT_STEADY, Comparison, Result

if TYPE_CHECKING:
    from mesokit.case.case import Case

MATTERS = 0.5  # of the standard error: a missing part that is larger is told


class BuildUp(NamedTuple):
    """How a flow from rest comes to its steady state: what it lacks falls as an exponential.

    steps: in which that falls to 1/e; need: that `mesokit check` asks to wait for before the first
    sample; had: that the run waited.
    """

    steps: float
    need: int
    had: int

    def lacks(self, length: float) -> float:
        """The part of the steady flow that the mean over so many steps lacks.

        >>> round(BuildUp(1200.0, 3600, 100).lacks(500), 2)
        0.75
        """
        left = math.exp(-self.had / self.steps)
        return left * -math.expm1(-length / self.steps) * self.steps / length


def result_of(accumulator: Accumulator, case: Case) -> Result:
    """What an accumulator says, with comparisons marked where the flow had not built up."""
    result, method = accumulator.result(), method_of(case)
    observable = next((one for one in case.observe if one.label == result.name), None)
    if method.build_up is None or observable is None or not observable.of_built_up_flow:
        return result
    build_up = method.build_up(case)
    if build_up is None:
        return result
    length = min(result.samples * observable.every, case.run.steps)
    if not length or not any(_is_off(c, build_up.lacks(length)) for c in result.comparisons):
        return result
    note = f"{NOT_STEADY}: the flow needs {build_up.need} steps before samples, had {build_up.had}"
    return dataclasses.replace(
        result, comparisons=tuple(dataclasses.replace(c, note=note) for c in result.comparisons)
    )


def _is_off(comparison: Comparison, share: float) -> bool:
    """Whether the part that is missing would be seen."""
    return share * abs(comparison.expected) > MATTERS * comparison.error > 0
