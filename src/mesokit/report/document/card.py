"""A small table in HTML, as notebooks show an object."""

from collections.abc import Iterable
from typing import Any

from mesokit.report.document.tables import lines_of
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
    found = {"rows": list(rows), "lines": lines_of(results), "numbers": numbers}
    how = {"fold": fold, "pretty": pretty}
    return render("card.html", title=title, words=words, text=text, **found, **how)
