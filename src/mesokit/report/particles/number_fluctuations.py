"""How much numbers fluctuate against their means, on logarithmic axes, and a guide to the slope."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.observe.shared.result import Result
from mesokit.report.particles import structure_factor
from mesokit.report.style import COLOURS, legend_above

GUIDED = 4  # of the last points, through whose middle a guide goes


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Data with error bars, places at random, and a slope beside where one is known."""
    ax = figure.subplots() if ax is None else ax
    slope, (mean,) = result.extra.get("guide", np.nan), result.x.values()
    x, y = np.asarray(mean)[-GUIDED:], result.value[-GUIDED:]
    if len(x) > 1 and np.isfinite(slope) and (y > 0).all():
        middle = np.exp(np.log(x).mean())
        guide = np.exp(np.log(y).mean()) * (x / middle) ** slope
        label = f"slope {slope:g} (Toner and Tu, ordered flocks)"
        ax.plot(x, guide, "--", lw=1.2, color=COLOURS[1], label=label, zorder=1)
    structure_factor.draw(result, figure, ax)
    legend_above(ax, 2)
