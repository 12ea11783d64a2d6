"""Rows of tables: measured against expected, and what was conserved."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from mesokit.report.table import cells
from mesokit.seam.result import Result

SERIES = "conservation"  # the quantity that is a series of conserved numbers


class Line(NamedTuple):
    """One comparison in words; `first` of its result, `far` if theory is many errors away."""

    result: str
    first: bool
    what: str
    measured: str
    expected: str
    unit: str
    deviation: str
    note: str
    far: bool


def lines_of(results: Iterable[Result]) -> list[Line]:
    """A line for each comparison of these results.

    >>> from mesokit import Comparison
    >>> slip = Comparison("slip", 0.5, 0.1, 0.0, "a/tau", "the run is short")
    >>> line, = lines_of([Result("q", "profile", {}, 1, 0, "v", {}, comparisons=(slip,))])
    >>> line.measured, line.deviation, line.note, line.far
    ('0.50(10)', '+5.0 s.e.', 'the run is short', True)
    """
    return [
        Line(result.name, number == 0, *cells(c), c.far)
        for result in results
        for number, c in enumerate(result.comparisons)
    ]


def changes(results: Iterable[Result]) -> list[tuple[str, ...]]:
    """Name with unit, first, mean and last value, and largest change since the first sample."""
    found = []
    for result in results:
        if result.quantity != SERIES or not len(result.value):
            continue
        for name, column in zip(result.x["component"], result.value.T, strict=True):
            unit = result.units.get(str(name), "")
            words = f"{str(name).replace('_', ' ')}{f', {unit}' if unit else ''}"
            largest = np.max(np.abs(column - column[0]))
            numbers = (column[0], column.mean(), column[-1], largest)
            found.append((words, *(f"{x:.6g}" for x in numbers)))
    return found
