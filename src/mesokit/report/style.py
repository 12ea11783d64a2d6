"""How figures look: readable in print, in grey, and on a projector."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from mesokit.observe.shared.result import Comparison, with_error

WIDTH, HEIGHT = 6.4, 4.8  # inches
MARKERS = "osD^v<>pP*X"
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
# dark enough for white paper, and each of its own grey
COLOURS = ("#1b4f8a", "#c1491d", "#2a7f4f", "#7a3b8f", "#8a6d1b", "#444444")
STYLE: Any = {
    "text.usetex": False,  # users' settings apply but for this: TeX may not be there
    "font.size": 10,
    "axes.labelsize": 11,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "errorbar.capsize": 2,
    "lines.markersize": 4,
    "savefig.dpi": 200,
}
_SYMBOLS = {
    "a": "a", "tau": r"\tau", "m": "m", "1/a": "a^{-1}", "1/tau": r"\tau^{-1}", "a^2": "a^2",
    "a/tau": r"a/\tau", "a^2/tau": r"a^2/\tau", "a^2/tau^2": r"a^2/\tau^2",
    "1/a^2": "a^{-2}", "1/a^3": "a^{-3}",
    "m a^2/tau^2": r"m a^2/\tau^2", "m a/tau": r"m a/\tau", "m a/tau^2": r"m a/\tau^2",
    "m/tau^2": r"m/\tau^2", "a^3/tau": r"a^3/\tau", "m/(a tau^2)": r"m/(a\tau^2)",
}  # fmt: skip


def symbols(unit: str) -> str:
    """A unit as Matplotlib writes it, without the brackets; texts stay texts.

    >>> symbols("a^2/tau"), symbols("% of the flow")
    ('$a^2/\\\\tau$', '% of the flow')
    """
    return f"${_SYMBOLS[unit]}$" if unit in _SYMBOLS else unit


def labelled(label: str, unit: str) -> str:
    """An axis label with its unit."""
    return f"{label}  [{symbols(unit)}]" if unit else label


def compared(comparisons: Iterable[Comparison]) -> str:
    """Lines for a box in a figure: measured with error, theory, deviation."""
    return "\n".join(_line(c) for c in comparisons)


def _line(c: Comparison) -> str:
    text = f"{c.what}: {with_error(c.measured, c.error)} {symbols(c.unit)}".rstrip()
    if c.expected == c.expected and (c.expected or c.error > 0):
        text += f"   (theory {c.expected:.4g}"
        if c.approximate:
            text += f", approximate, {c.percent:+.2g} %)"
        else:
            text += f", {c.deviation:+.1f} s.e.)" if c.error > 0 else ")"
    elif c.expected != c.expected and c.note:
        text += f"   ({c.note})"
    return text


def below(figure: Any, comparisons: Iterable[Comparison]) -> None:
    """Write the comparisons under the axes, where they hide no data."""
    text = compared(comparisons)
    if text:
        figure.supxlabel(text, fontsize=8, ha="left", x=0.02, linespacing=1.5)
