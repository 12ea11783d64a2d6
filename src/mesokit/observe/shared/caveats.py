"""Caveats that pooled numbers take from the notes of their runs."""

import dataclasses
from collections.abc import Iterable, Sequence

from mesokit.seam.named import keyed
from mesokit.seam.result import LOWER_BOUND, NOT_STEADY, Comparison, Result

ROUGH = "approximate"
STEADY = ("steady", "steady flow")  # what theory is of
BUILDS_UP = f"{NOT_STEADY}: the flow "  # of a flow whose samples began too early
FEW_SAMPLES = "samples, which may be correlated"


def with_those_of(result: Result, runs: Sequence[Result]) -> Result:
    """A pooled result whose comparisons have the caveats of its runs, however near theory is.

    A lower bound holds for all samples where most of the runs have it: one may by chance. That a
    run has few samples means nothing for all runs together. Whether a flow has built up follows
    from all samples, for the momentum of one run may be off by chance.
    """
    each = [keyed(run.comparisons) for run in runs]
    comparisons = tuple(
        _with(comparison, [found[key].note for found in each if key in found])
        for key, comparison in keyed(result.comparisons).items()
    )
    return dataclasses.replace(result, comparisons=comparisons)


def _with(pooled: Comparison, notes: Sequence[str]) -> Comparison:
    """A pooled comparison with a caveat from the notes of the same number in each run.

    >>> _with(Comparison("slip", 0.1, 0.2), ["not steady: a; b", "not steady: c"]).note
    'not steady: a'
    >>> _with(Comparison("slip", 0.1, 0.2, note="steady flow"), ["not steady: a; b"]).note
    'not steady: a'
    >>> _with(Comparison("slip", 0.1, 0.2, note="law"), ["not steady: the flow needs 9 steps"]).note
    'law'
    """
    first, *others = pooled.note.split("; ")
    said = [first if not pooled.steady else _first(notes, NOT_STEADY, but=BUILDS_UP)]
    said += [_first(notes, ROUGH) if not pooled.approximate else "", first, *others]
    bounds = [note for note in notes if LOWER_BOUND in note and FEW_SAMPLES not in note]
    most = len(bounds) > len(notes) / 2
    if most and LOWER_BOUND not in pooled.note and pooled.error > 0:
        said.append(_first(bounds, LOWER_BOUND))
    if said[0]:  # error bars of a flow that changes are another matter
        said = [part for part in said if LOWER_BOUND not in part and part not in STEADY]
    return dataclasses.replace(pooled, note="; ".join(filter(None, dict.fromkeys(said))))


def _first(notes: Iterable[str], words: str, but: str = "; ") -> str:
    """The first part of any of the notes that has these words and not others, "" if none has."""
    parts = (part for note in notes for part in note.split("; "))
    return next((part for part in parts if words in part and but not in part), "")
