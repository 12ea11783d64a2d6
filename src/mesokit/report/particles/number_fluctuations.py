"""How much numbers fluctuate against their means: powers are straight on logarithmic axes."""

from typing import Any

import numpy as np

from mesokit.report.curve import BARS
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, labelled, sparse_logarithm
from mesokit.seam.result import Result

GUIDED = 4  # of the last points, through whose middle a guide goes


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Data with error bars, birds at random, and the power of large ordered flocks in these."""
    ax = figure.subplots() if ax is None else ax
    slope, (mean,) = result.extra.get("guide", np.nan), result.x.values()
    x, y = np.asarray(mean, float), result.value
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.errorbar(x, y, result.error, fmt="o", mfc="white", lw=0.8, color=COLOURS[0], label=BARS)
    if result.expected is not None:
        birds = x[-1] ** 2 / (x[-1] - result.expected[-1] ** 2)  # which are n (1 - n/birds) there
        n = np.geomspace(x[0], x[-1], 200)
        random = np.sqrt(n * (1 - n / birds))
        label = r"birds at random, $\sqrt{\langle n\rangle}$ in a large box"
        ax.plot(n[random > 0], random[random > 0], color="black", lw=1.2, label=label, zorder=1)
    last = slice(-GUIDED, None)
    if len(x) > 1 and np.isfinite(slope) and (y[last] > 0).all():
        middle, level = (np.exp(np.log(z[last]).mean()) for z in (x, y))
        ends = x[[0, -1]]
        label = rf"$\langle n\rangle^{{{slope:g}}}$ (Toner and Tu, ordered flocks)"
        guide = level * (ends / middle) ** slope
        ax.plot(ends, guide, "--", lw=1.2, color=COLOURS[1], label=label, zorder=1)
    sparse_logarithm(ax.xaxis, *ax.get_xlim())
    sparse_logarithm(ax.yaxis, *ax.get_ylim())
    ax.set_xlabel(labelled(r"mean number $\langle n\rangle$", ""))
    ax.set_ylabel(labelled(result.label, result.units.get("value", "")))
    legend_above(ax, 2)
