"""Whether a flow had built up when samples were taken: else its mean is not that of theory."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from mesokit.method.protocol import method_of
from mesokit.observe.shared.protocol import Accumulator
from mesokit.observe.shared.result import NOT_STEADY, Comparison, Result
from mesokit.observe.shared.short_run import bounded

if TYPE_CHECKING:
    from mesokit.case.case import Case

MATTERS = 0.5  # of the standard error: a missing part that is larger is told


def result_of(accumulator: Accumulator, case: Case) -> Result:
    """What an accumulator says, with comparisons marked where the flow had not built up, or where
    the run is too short for error bars."""
    result, method = bounded(accumulator.result(), accumulator), method_of(case)
    observable = next((one for one in case.observe if one.label == result.name), None)
    if method.build_up is None or observable is None or not observable.of_built_up_flow:
        return result
    build_up = method.build_up(case)
    if build_up is None:
        return result
    series = getattr(getattr(accumulator, "blocks", None), "series", 1)  # pooled runs
    length = result.samples // series * observable.every
    if not length or not any(_is_off(c, build_up.lacks(length)) for c in result.comparisons):
        return result
    note = f"{NOT_STEADY}: the flow needs {build_up.need} steps before samples, had {build_up.had}"
    return dataclasses.replace(
        result,
        comparisons=tuple(
            dataclasses.replace(c, note="; ".join([note, *_of_theory(c)]))
            for c in result.comparisons
        ),
    )


def _of_theory(comparison: Comparison) -> list[str]:
    """What its note says of the theory; error bars of a flow that builds up are another matter."""
    parts = comparison.note.split("; ")
    return [part for part in parts if part and not part.startswith("error bar is a lower bound")]


def _is_off(comparison: Comparison, share: float) -> bool:
    """Whether the part that is missing would be seen."""
    return share * abs(comparison.expected) > MATTERS * comparison.error > 0
