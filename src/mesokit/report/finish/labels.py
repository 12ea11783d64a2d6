"""Labels of axes that are no longer than their axes."""

import itertools
import re
from typing import Any

MOST = 3  # lines
_WORD = re.compile(r"(?:\$[^$]*\$|[^\s$])+")  # a formula is not broken
_NO_WIDTH = re.compile(r"\\mathrm|\\,|[{}$^_]")
_SIGN = re.compile(r"\\[a-zA-Z]+")


def fit_labels(figure: Any) -> None:
    """Break labels of axes that are longer than their axis into lines: neighbours stay apart."""
    figure.get_layout_engine().execute(figure)
    for ax in figure.axes:
        box = ax.get_window_extent()
        for axis, room in ((ax.xaxis, box.width), (ax.yaxis, box.height)):
            _fit(axis.label, room, axis is ax.xaxis)


def _fit(label: Any, room: float, level: bool) -> None:
    text = label.get_text()
    for lines in range(text.count("\n") + 2, MOST + 1):
        box = label.get_window_extent()
        if (box.width if level else box.height) <= room:
            return
        label.set_text(in_lines(text, lines))


def in_lines(text: str, lines: int) -> str:
    r"""A label in so many lines, or fewer where it has not enough words, about equally long.

    >>> in_lines("mean square displacement  [$a^2$]", 2)
    'mean square\ndisplacement [$a^2$]'
    """
    words = _WORD.findall(text)
    count = min(lines, len(words))
    found = []
    for inner in itertools.combinations(range(1, len(words)), count - 1):
        ends = itertools.pairwise((0, *inner, len(words)))
        found.append([" ".join(words[first:last]) for first, last in ends])
    return "\n".join(min(found, key=lambda each: max(map(_letters, each))))


def _letters(text: str) -> int:
    """About how many letters wide a text with formulas is."""
    return len(_SIGN.sub("x", _NO_WIDTH.sub("", text)))
