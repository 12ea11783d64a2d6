"""A small table in HTML, as notebooks show an object."""

from collections.abc import Iterable
from typing import Any

from mesokit.report.document.comparisons import lines_of
from mesokit.report.document.template import render
from mesokit.seam.result import Result


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
