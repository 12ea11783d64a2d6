"""Whether a flow had built up when samples were taken: else its mean is not that of theory."""

from __future__ import annotations

import copy
import dataclasses
import math
from typing import TYPE_CHECKING, Any

from mesokit.observe.shared.short_run import bounded
from mesokit.seam.method import method_of
from mesokit.seam.observable import Accumulator
from mesokit.seam.result import NOT_STEADY, Comparison, Result, with_error

if TYPE_CHECKING:
    from mesokit.case.case import Case

MATTERS = 0.5  # of the standard error: a missing part that is larger is told
DRIFTS = 5.0  # standard errors between both halves of the samples: the flow still changes


def result_of(accumulator: Accumulator, case: Case) -> Result:
    """What an accumulator says, with comparisons marked where the flow had not built up, or where
    the run is too short for error bars."""
    result = bounded(accumulator.result(), accumulator)
    observable = next((one for one in case.observe if one.label == result.name), None)
    if observable is None or not observable.of_built_up_flow:
        return result
    note = _too_early(accumulator, result, case, observable.every) or _drift(accumulator, result)
    if not note:
        return result
    return dataclasses.replace(
        result,
        comparisons=tuple(
            dataclasses.replace(c, note="; ".join([note, *_of_theory(c)]))
            for c in result.comparisons
        ),
    )


def _too_early(accumulator: Accumulator, result: Result, case: Case, every: int) -> str:
    """That samples began before the flow had built up, where the method knows how long it takes."""
    method = method_of(case)
    build_up = method.build_up(case) if method.build_up is not None else None
    if build_up is None:
        return ""
    series = getattr(getattr(accumulator, "blocks", None), "series", 1)  # pooled runs
    length = result.samples // series * every
    if not length or not any(_is_off(c, build_up.lacks(length)) for c in result.comparisons):
        return ""
    return f"{NOT_STEADY}: the flow needs {build_up.need} steps before samples, had {build_up.had}"


def _drift(accumulator: Accumulator, result: Result) -> str:
    """That both halves of the samples differ by more than they scatter."""
    blocks = getattr(accumulator, "blocks", None)
    halves = []
    for part in blocks.halves() if blocks is not None else ():
        half: Any = copy.copy(accumulator)
        half.blocks = part
        halves.append({c.what: c for c in half.result().comparisons})
    first, second = halves or ({}, {})
    known = [c.what for c in result.comparisons if math.isfinite(c.measured + c.expected)]
    for what in [what for what in known if what in first and what in second]:
        one, other = first[what], second[what]
        apart = abs(one.measured - other.measured)
        if apart > DRIFTS * math.hypot(one.error, other.error) > 0:
            early, late = (with_error(c.measured, c.error) for c in (one, other))
            return f"{NOT_STEADY}: {what} {early} in the first half, {late} in the second"
    return ""


def _of_theory(comparison: Comparison) -> list[str]:
    """What its note says of the theory; error bars of a flow that builds up are another matter."""
    parts = comparison.note.split("; ")
    return [part for part in parts if part and not part.startswith("error bar is a lower bound")]


def _is_off(comparison: Comparison, share: float) -> bool:
    """Whether the part that is missing would be seen; of few samples, whose error is unknown,
    whether it is more than a twentieth."""
    missing = share * abs(comparison.expected)
    if not comparison.error > 0:
        return share > 0.05 and missing > 0
    return missing > MATTERS * comparison.error
