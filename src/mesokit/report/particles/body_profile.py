"""Bodies across an axis: how many there are in a slice, and the order of their axes."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import LINES, MEASURED, labelled, points, theory_of
from mesokit.seam.result import Result

MORE = 1.0  # inches for the lower panel


def draw(result: Result, figure: Any, ax: Any) -> None:
    """The density beside theory, and below the mean direction and the nematic order; in given axes
    the density alone."""
    (axis, place), names = next(iter(result.x.items())), [str(name) for name in result.x["of"]]
    below = None
    if ax is None:
        figure.set_figheight(figure.get_figheight() + MORE)
        ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    points(ax, place, result.value[:, 0], result.error[:, 0], lw=0.8, ms=3, label=MEASURED)
    if result.expected is not None and np.isfinite(result.expected[:, 0]).any():
        ax.plot(place, result.expected[:, 0], color="black", lw=1.4, label=theory_of(result))
    ax.set_ylabel(labelled("density", result.units["density"]))
    ax.set_ylim(bottom=0)
    ax.set_xlim(*result.extra["edges"][[0, -1]])
    legend_above(ax)
    if below is not None:
        for k, name in enumerate(names[1:], start=1):
            label = name.replace("heading ", "mean heading $") + "$" * name.startswith("heading")
            value, error = result.value[:, k], result.error[:, k]
            look: Any = {"ls": LINES[k - 1], "lw": 0.8, "ms": 3, "capsize": 0}
            points(below, place, value, error, k - 1, label=label, **look)
        below.axhline(0, color="black", lw=0.8, ls=":", zorder=1)
        below.set(ylabel="order", ylim=_limits(result))
        below.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    (below or ax).set_xlabel(labelled(f"${axis}$", result.units[axis]))


def _limits(result: Result) -> tuple[float, float]:
    """From the least to the largest order that is above noise, at least from -0.3 to 0.3."""
    value = result.value[:, 1:]
    sure = value[np.isfinite(value) & ~(result.error[:, 1:] > 0.2)]
    return min(-0.3, 1.1 * sure.min(initial=0.0)), max(0.3, 1.1 * sure.max(initial=0.0))
