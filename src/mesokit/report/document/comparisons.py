"""The rows of a table of measured against expected."""

from collections.abc import Iterable
from typing import NamedTuple

from mesokit.report.table import cells
from mesokit.seam.result import Result


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
