"""How figures look: readable in print, in grey, and on a projector."""

import itertools
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from mesokit.report.caption import mathematics, symbols
from mesokit.seam.in_units import shown
from mesokit.seam.result import Result

WIDTH, HEIGHT = 6.4, 4.8  # inches
LEAST_HEIGHT, LEAST_FONT = 0.7, 0.75  # of the usual, however narrow a figure is
ERROR = r"$\pm$ one standard error"
MEASURED = f"measured, {ERROR}"  # the label of data with error bars
MARKERS = "osD^v<>pP*X"
LINES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)))
LETTERS = "abcdefghijkl"  # of panels
# dark enough for white paper, and each of its own grey
COLOURS = ("#1b4f8a", "#d4552a", "#1f7346", "#57206b", "#bd8f1c", "#222222")
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


def fonts(width: float) -> dict[str, float]:
    """Sizes of letters in a figure that is narrower than usual: no smaller than can be read.

    >>> fonts(6.4), fonts(3.2)["font.size"]
    ({}, 7.5)
    """
    if width >= WIDTH:
        return {}
    names = ("font.size", "axes.labelsize", "legend.fontsize")
    factor = max(width / WIDTH, LEAST_FONT)
    return {name: STYLE[name] * factor for name in names} | {"axes.titlesize": 10 * factor}


def height_of(width: float) -> float:
    """The usual height of a figure that is so wide, in inches.

    >>> height_of(6.4), round(height_of(3.2), 2)
    (4.8, 3.36)
    """
    return HEIGHT * max(width / WIDTH, LEAST_HEIGHT)


def looks() -> Iterator[tuple[Any, str]]:
    """Dash and colour of one curve after another, for pictures with many lines.

    >>> [dash for dash, colour in itertools.islice(looks(), 3)]
    ['-', '--', '-.']
    >>> len(set(itertools.islice(looks(), 36)))
    36
    """
    for i in itertools.count():
        yield LINES[i % len(LINES)], COLOURS[(i + i // len(LINES)) % len(COLOURS)]


def labelled(label: str, unit: str) -> str:
    """An axis label with its unit, unless that is a word of it; a letter alone is a symbol.

    >>> labelled("q", "1/a")
    '$q$  [$a^{-1}$]'
    >>> labelled("time lag $t$", "time")
    'time lag $t$'
    """
    label = f"${label}$" if len(label) == 1 and label.isalpha() else label
    if shown().of(unit) in label.split():  # time in units of time
        unit = ""
    return f"{mathematics(label)}  [{symbols(unit)}]".lstrip() if unit else mathematics(label)


def theory_of(result: Result) -> str:
    """The label of what theory expects."""
    return mathematics(f"theory: {result.theory}")


def points(ax: Any, x: Any, value: Any, error: Any, number: int = 0, **look: Any) -> None:
    """Draw data with error bars, in the marker and colour of a series; `look` changes these."""
    usual = {"fmt": MARKERS[number % len(MARKERS)], "color": COLOURS[number % len(COLOURS)]}
    ax.errorbar(x, value, error, **usual | {"mfc": "white"} | look)


def mean_line(ax: Any, mean: float, error: float, label: str = "mean", number: int = 1) -> None:
    """Draw a mean as a dashed line, and its standard error, if known, as a band."""
    known, colour = bool(np.isfinite(error)), COLOURS[number % len(COLOURS)]
    label = f"{label}, {ERROR}" if known else label
    ax.axhline(mean, color=colour, ls="--", lw=1.3, label=label)
    if known:
        ax.axhspan(mean - error, mean + error, color=colour, alpha=0.25, lw=0)


def time_axis(ax: Any, time: Any, unit: str) -> None:
    """Label an axis of time, which ends with the data."""
    ax.set_xlabel(labelled("time $t$", unit))
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])


def lettered(panels: Sequence[Any]) -> None:
    """Letters (a), (b), ... before the titles of several panels, or in their place."""
    for letter, ax in zip(LETTERS, panels, strict=False):
        if len(panels) > 1:
            title = next(filter(None, map(ax.get_title, ("left", "center"))), "")
            ax.set_title("")
            ax.set_title(f"({letter}) {title}".rstrip(), loc="left", fontsize=10)


def sparse_logarithm(axis: Any, least: float, most: float) -> None:
    """Write powers of ten on a logarithmic axis, and over less than two decades 2 and 5 times as
    much, so that numbers do not overlap."""
    from matplotlib.ticker import NullFormatter

    few = least > 0 and most / least < 100
    axis.set_minor_formatter(
        (lambda x, _: f"{x:g}" if f"{x:e}"[0] in "25" else "") if few else NullFormatter()
    )
    if few:
        axis.set_major_formatter(lambda x, _: f"{x:g}")
