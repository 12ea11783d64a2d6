"""A small table in HTML, as notebooks show an object."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

from mesokit.report.document.template import render
from mesokit.report.table import SUSPICIOUS, cells
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
        Line(result.name, number == 0, *cells(c), abs(c.deviation) > SUSPICIOUS)
        for result in results
        for number, c in enumerate(result.comparisons)
    ]


def card(
    title: str,
    words: str = "",
    rows: Iterable[tuple[str, str, str]] = (),
    results: Iterable[Result] = (),
    text: str = "",
    fold: str = "all of it",
    pretty: bool = False,
    numbers: Any = None,
) -> str:
    """A title with some words, facts, comparisons of results, and a text that can be unfolded.

    `pretty` sets powers and indices of the facts as such; `numbers` is the table of a study.

    >>> "<b>box</b> empty" in card("box", "empty")
    True
    """
    lines = lines_of(results)
    facts = list(rows)
    return render(
        "card.html",
        title=title,
        words=words,
        rows=facts,
        lines=lines,
        text=text,
        fold=fold,
        pretty=pretty,
        numbers=numbers,
    )
