"""Whether a flow had built up when samples were taken: else its mean is not that of theory."""

import copy
import dataclasses
import math
from typing import Any, Protocol, runtime_checkable

from mesokit.case.case import Case
from mesokit.case.describe.digits import two_digits
from mesokit.observe.shared.caveats import BUILDS_UP, LOWER_BOUND, STEADY
from mesokit.observe.shared.short_run import CHI_SQUARE, bounded, without_error
from mesokit.seam.in_units import in_units
from mesokit.seam.method import BuildUp, method_of
from mesokit.seam.observable import Accumulator
from mesokit.seam.result import NOT_STEADY, Comparison, Result, with_error

MATTERS = 0.5  # of the standard error: a missing part that is larger is told
MUCH = 0.05  # of the speed: a missing part that is larger is told, whatever the error
DRIFTS = 5.0  # standard errors between both halves of the samples: the flow still changes


@runtime_checkable
class OfFlow(Protocol):
    """An accumulator that sees how long its flow takes to build up."""

    def build_up(self) -> BuildUp | None:
        """How the flow came from rest, None where that is not known."""


def result_of(accumulator: Accumulator, case: Case) -> Result:
    """What an accumulator says, with comparisons marked where the flow had not built up, or where
    the run is too short for error bars."""
    found = without_error(bounded(accumulator.result(), accumulator), accumulator)
    result = in_units(found, case)
    observable = next((one for one in case.observe if one.label == result.name), None)
    if observable is None:
        return result
    length = _length(accumulator, result) * observable.every
    if observable.of_built_up_flow:
        build_up, estimated = _build_up(accumulator, case)
        early = drift = ""
        if build_up is not None:
            early = _too_early(build_up, estimated, result, length, observable.in_any_flow)
        if not (early or _is_short(build_up, length)):
            drift = _drift(accumulator, result)
        result = _marked(_marked(result, early, observable.in_any_flow), drift)
    steps = case.run.warmup + min(length, case.run.steps)
    heat = method_of(case).heat_caveat(case, steps)
    return _marked(result, heat, observable.at_any_kT)


def _marked(result: Result, note: str, but: tuple[str, ...] = ()) -> Result:
    """With a note in front of those of its comparisons, but of those with such words in their
    names, or that are not steady for another reason."""
    if not note:
        return result
    return dataclasses.replace(
        result,
        comparisons=tuple(
            c
            if not c.steady or _has(c, but)
            else dataclasses.replace(c, note="; ".join([note, *_of_theory(c, note)]))
            for c in result.comparisons
        ),
    )


def _has(comparison: Comparison, words: tuple[str, ...]) -> bool:
    """Whether any of these words are in its name."""
    return any(one in comparison.what for one in words)


def _length(accumulator: Accumulator, result: Result) -> int:
    """Samples of each run that is pooled in it."""
    series = getattr(getattr(accumulator, "blocks", None), "series", 1)
    return int(result.samples // series)


def _build_up(accumulator: Accumulator, case: Case) -> tuple[BuildUp | None, bool]:
    """How the flow came from rest, and whether that is estimated from the flow itself; None where
    neither the method nor the flow gives it."""
    method = method_of(case)
    known = method.build_up(case) if method.build_up is not None else None
    if known is None and isinstance(accumulator, OfFlow):
        return accumulator.build_up(), True
    return known, False


def _is_short(build_up: BuildUp | None, length: int) -> bool:
    """Whether samples began late enough, but span less than a relaxation time of the flow: then
    fluctuations alone tell the halves apart."""
    return build_up is not None and build_up.had >= build_up.need and length < build_up.steps


def _too_early(
    build_up: BuildUp, estimated: bool, result: Result, length: int, but: tuple[str, ...]
) -> str:
    """That samples began before the flow had built up; by all numbers but those with such words in
    their names."""
    lacks = build_up.lacks(length) if length else 0.0
    enough = build_up.had >= build_up.need  # then only an error bar that is known tells more
    of_flow = [c for c in result.comparisons if not _has(c, but)]
    seen = [c for c in of_flow if not (enough and LOWER_BOUND in c.note)]
    if not any(_is_off(c, lacks) for c in seen):
        return ""
    if enough:
        return f"{BUILDS_UP}still lacked {100 * lacks:.2g} % of its speed"
    need = f"up to {two_digits(build_up.need)}" if estimated else f"{build_up.need}"
    return f"{BUILDS_UP}needs {need} steps before samples, had {build_up.had}"


def _drift(accumulator: Accumulator, result: Result) -> str:
    """That both halves of the samples differ by more than they scatter. A chi-square is of that
    scatter itself, and is left out."""
    blocks = getattr(accumulator, "blocks", None)
    halves = []
    for part in blocks.halves() if blocks is not None else ():
        half: Any = copy.copy(accumulator)
        half.blocks = part
        halves.append({c.what: c for c in half.result().comparisons})
    first, second = halves or ({}, {})
    known = [c.what for c in result.comparisons if math.isfinite(c.measured + c.expected)]
    both = [what for what in known if what in first and what in second and CHI_SQUARE not in what]
    for what in both:
        one, other = first[what], second[what]
        apart = abs(one.measured - other.measured)
        if apart > DRIFTS * math.hypot(one.error, other.error) > 0:
            early, late = (with_error(c.measured, c.error) for c in (one, other))
            return f"{NOT_STEADY}: {what} {early} in the first half, {late} in the second"
    return ""


def _of_theory(comparison: Comparison, caveat: str) -> list[str]:
    """What its note says beside a caveat: of what is not steady nothing of steady flow, and nothing
    of error bars, which are another matter there."""
    parts = [part for part in comparison.note.split("; ") if part]
    if not caveat.startswith(NOT_STEADY):
        return parts
    return [one for one in parts if one not in STEADY and not one.startswith(LOWER_BOUND)]


def _is_off(comparison: Comparison, share: float) -> bool:
    """Whether the part that is missing is more than a twentieth, or would be seen beside the error
    bar. In a flow that builds up the error bar grows with what is missing."""
    expected = comparison.expected
    missing = share * abs(comparison.measured if math.isnan(expected) else expected)
    return missing > MATTERS * comparison.error or (share > MUCH and missing > 0)
