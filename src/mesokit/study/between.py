"""Theory between the points of a study: expectations for cases that were not run."""

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from mesokit.errors import MesokitError
from mesokit.io.measured import measured
from mesokit.seam.named import keyed
from mesokit.study.dependence import Theory
from mesokit.study.plan import Base, Planned
from mesokit.study.table import Pooled

FEWEST, SMOOTH = 7, 40  # places between two points; of a curve
ALIKE = 1e-9  # part by which two expectations may differ


def theory_between(
    base: Base, runs: Sequence[Planned], rows: Sequence[Pooled], keys: Sequence[str], log: bool
) -> Theory | None:
    """Expectation of a number between its points; None if it cannot be computed.

    Parameters
    ----------
    base: the case that all runs share.
    runs: all runs of the study; a theory may need measured numbers.
    rows: the number at the points of one curve, which is drawn against the first key.
    keys: key paths of the axis, whose values change together.
    log: whether places between two points have equal ratios.

    A place uses the measured numbers of both neighbours. If these lead to different expectations,
    as in different phases, it has none.
    """
    key = keys[0]
    rows = sorted(rows, key=lambda row: float(row.point[key]))
    x, expected = [float(rows[0].point[key])], [rows[0].number.expected]
    try:
        memories = [_memory(runs, row) for row in rows]
        inside = max(FEWEST, SMOOTH // max(len(rows) - 1, 1))
        for k, (low, high) in enumerate(itertools.pairwise(rows)):
            for point in _points(low.point, high.point, keys, log, inside):
                found = [_expected(base, point, low, memory) for memory in memories[k : k + 2]]
                alike = math.isclose(found[0], found[1], rel_tol=ALIKE)
                x.append(float(point[key]))
                expected.append(found[0] if alike else np.nan)
            x.append(float(high.point[key]))
            expected.append(high.number.expected)
    except (MesokitError, KeyError, ValueError, IndexError):  # memories of another shape, and so on
        return None
    new = np.isin(x, [float(row.point[key]) for row in rows], invert=True)
    return Theory(np.array(x), np.array(expected)) if np.isfinite(expected)[new].any() else None


def _memory(runs: Sequence[Planned], row: Pooled) -> Mapping[str, Any]:
    """State of the observable of a number in the first run at its point."""
    run = next(run for run in runs if run.point == row.point and run.ended)
    accumulators, _ = measured(run.files.directory, run.files.case)
    return cast(Mapping[str, Any], accumulators[row.observable].state())


def _points(
    low: Mapping[str, Any], high: Mapping[str, Any], keys: Sequence[str], log: bool, inside: int
) -> list[dict[str, Any]]:
    """Points between two others. Raises ValueError for a value that is no number, and changes."""
    space = np.geomspace if log else np.linspace
    first, last = (float(point[keys[0]]) for point in (low, high))
    places = space(first, last, inside + 2)[1:-1]
    points = []
    for share in (places - first) / (last - first):
        point = {**low, **{key: _mixed(low[key], high[key], share) for key in keys}}
        if point[keys[0]] not in (low[keys[0]], high[keys[0]]) and point not in points:
            points.append(point)
    return points


def _mixed(low: Any, high: Any, share: float) -> Any:
    """A value between two, a whole number between whole numbers."""
    if low == high:
        return low
    if not all(isinstance(value, int | float) for value in (low, high)):
        raise ValueError(f"nothing lies between {low} and {high}")
    value = low + share * (high - low)
    return round(value) if isinstance(low, int) and isinstance(high, int) else float(value)


def _expected(
    base: Base, point: Mapping[str, Any], row: Pooled, memory: Mapping[str, Any]
) -> float:
    """Expectation of the number at a point, from its observable with this memory."""
    case = base.case(point, 1)
    observable = next(one for one in case.observe if one.label == row.observable)
    accumulator = observable.accumulator(case)
    accumulator.restore(memory)
    with np.errstate(all="ignore"):
        return float(keyed(accumulator.result().comparisons)[row.key].expected)
