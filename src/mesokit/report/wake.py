"""The velocity behind a body: where it passes zero."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, labelled
from mesokit.seam.result import Result


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Velocity against the distance from the rear, with the length of the part that flows back.

    Distances are over the size D of the body, and at the right velocities over the mean one.
    """
    ax = figure.subplots() if ax is None else ax
    length, size = result.extra["recirculation"], result.extra["size"]
    ax.axhline(0, color="black", lw=0.8, ls=":", zorder=1)
    ax.errorbar(
        result.x["distance"] / size,
        result.value,
        result.error,
        fmt="o",
        mfc="white",
        color=COLOURS[0],
        lw=0.8,
        label=r"measured, $\pm$ one standard error",
        zorder=2,
    )
    found = [c for c in result.comparisons if c.what == "L_r/D"]
    if np.isfinite(length) and found:
        ends, error = found[0].measured, found[0].error
        ax.axvline(ends, color=COLOURS[1], ls="--", lw=1.3, label="$L_r/D$, from a straight line")
        if np.isfinite(error):
            ax.axvspan(ends - error, ends + error, color=COLOURS[1], alpha=0.25, lw=0)
        if np.isfinite(found[0].expected):
            ax.axvline(found[0].expected, color="black", lw=1.5, label="theory")
    ax.set_xlim(*(result.extra["edges"][[0, -1]] / size))
    ax.set_xlabel(f"distance from the rear of the body over its size $D = {size:.4g}\\,a$")
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    legend_above(ax, columns=2)
    speed = result.extra.get("speed", np.nan)
    if np.isfinite(speed) and speed:
        right = ax.secondary_yaxis("right", functions=(lambda v: v / speed, lambda v: v * speed))
        letter = result.label.split()[-1]
        right.set_ylabel(rf"${letter}/U$,  $U = {speed:.3g}\,a/\tau$: superficial velocity")
        ax.tick_params(right=False)
