"""Caveats of flows that had not built up when samples were taken: theory is of steady flow."""

import copy
import dataclasses
import math
from typing import Any

from mesokit.case.case import Case
from mesokit.case.describe.digits import two_digits
from mesokit.observe.shared.caveats import BUILDS_UP, LOWER_BOUND, STEADY
from mesokit.observe.shared.short_run import CHI_SQUARE, bounded, without_error
from mesokit.seam.in_units import in_units
from mesokit.seam.method import BuildUp, method_of
from mesokit.seam.observable import Accumulator
from mesokit.seam.result import NOT_STEADY, Comparison, Result, with_error

MATTERS = 0.5  # of the standard error: a missing part that is larger is reported
MUCH = 0.05  # of the speed: a missing part that is larger is reported, whatever the error
DRIFTS = 5.0  # standard errors between both halves of the samples: the flow still changes


def result_of(accumulator: Accumulator, case: Case) -> Result:
    """Result of an accumulator, with comparisons marked where the flow had not built up, or where
    the run is too short for error bars."""
    found = without_error(bounded(accumulator.result(), accumulator), accumulator)
    result = in_units(found, case)
    observable = next((one for one in case.observe if one.label == result.name), None)
    if observable is None:
        return result
    runs = getattr(getattr(accumulator, "blocks", None), "series", 1)  # pooled in it
    length = int(result.samples // runs) * observable.every  # steps
    if observable.of_built_up_flow:
        build_up, estimated = _build_up(accumulator, case)
        early, short = "", False
        if build_up is not None:
            of_flow = [c for c in result.comparisons if not _has(c, observable.in_any_flow)]
            early = _too_early(build_up, estimated, of_flow, length)
            # within a relaxation time fluctuations alone can make the halves differ
            short = build_up.had >= build_up.need and length < build_up.steps
        drift = "" if early or short else _drift(accumulator, result)
        result = _marked(_marked(result, early, observable.in_any_flow), drift)
    steps = case.run.warmup + min(length, case.run.steps)
    heat = method_of(case).steadiness.heat_caveat(case, steps)
    return _marked(result, heat, observable.at_any_kT)


def _marked(result: Result, note: str, but: tuple[str, ...] = ()) -> Result:
    """The result with a note in front of the notes of its comparisons, except of those whose names
    have one of the words `but`, or that are not steady for another reason."""

    def marked(comparison: Comparison) -> Comparison:
        if not comparison.steady or _has(comparison, but):
            return comparison
        parts = comparison.note.split("; ")
        if note.startswith(NOT_STEADY):  # error bars of a flow that changes are another matter
            parts = [p for p in parts if p not in STEADY and not p.startswith(LOWER_BOUND)]
        return dataclasses.replace(comparison, note="; ".join(filter(None, [note, *parts])))

    if not note:
        return result
    return dataclasses.replace(result, comparisons=tuple(map(marked, result.comparisons)))


def _has(comparison: Comparison, words: tuple[str, ...]) -> bool:
    """True if any of these words are in its name."""
    return any(one in comparison.what for one in words)


def _build_up(accumulator: Accumulator, case: Case) -> tuple[BuildUp | None, bool]:
    """How the flow came from rest, None where that is unknown, and whether that is an estimate from
    the flow itself: the method `build_up` of an accumulator."""
    known = method_of(case).steadiness.build_up(case)
    of_flow = getattr(accumulator, "build_up", None)
    if known is None and of_flow is not None:
        return of_flow(), True
    return known, False


def _too_early(build_up: BuildUp, estimated: bool, of_flow: list[Comparison], length: int) -> str:
    """A note if samples began before the flow had built up.

    That is said if the missing part is more than a twentieth, or would be visible beside an error
    bar. In a flow that builds up the error bar grows with the missing part.
    """
    lacks = build_up.lacks(length) if length else 0.0
    enough = build_up.had >= build_up.need  # then only a known error bar says more
    for c in of_flow:
        missing = lacks * abs(c.measured if math.isnan(c.expected) else c.expected)
        off = missing > MATTERS * c.error or (lacks > MUCH and missing > 0)
        if off and not (enough and LOWER_BOUND in c.note):
            break
    else:
        return ""
    if enough:
        return f"{BUILDS_UP}still lacked {100 * lacks:.2g} % of its speed"
    need = f"up to {two_digits(build_up.need)}" if estimated else f"{build_up.need}"
    return f"{BUILDS_UP}needs {need} steps before samples, had {build_up.had}"


def _drift(accumulator: Accumulator, result: Result) -> str:
    """A note if both halves of the samples differ by more than they scatter. A chi-square measures
    that scatter itself, and is left out."""
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
