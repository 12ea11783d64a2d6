"""The velocity behind a body: where it passes zero."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.observe.shared.result import Result
from mesokit.report.style import COLOURS, labelled


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Velocity against the distance from the rear, with the length of the part that flows back."""
    ax = figure.subplots() if ax is None else ax
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    ax.errorbar(
        result.x["distance"],
        result.value,
        result.error,
        fmt="o",
        mfc="white",
        color=COLOURS[0],
        lw=0.8,
        label=r"measured, $\pm$ one standard error",
        zorder=2,
    )
    length, size = result.extra["recirculation"], result.extra["size"]
    found = [c for c in result.comparisons if c.what == "L_r/D"]
    if np.isfinite(length) and found:
        ax.axvline(length, color=COLOURS[1], ls="--", lw=1.3, label="$L_r$, from a straight line")
        error = found[0].error * size
        if np.isfinite(error):
            ax.axvspan(length - error, length + error, color=COLOURS[1], alpha=0.25, lw=0)
        if np.isfinite(found[0].expected):
            ax.axvline(found[0].expected * size, color="black", lw=1.5, label="theory")
    ax.set_xlim(*result.extra["edges"][[0, -1]])
    ax.set_xlabel(labelled("distance from the rear of the body", result.units["distance"]))
    ax.set_ylabel(labelled(f"velocity ${result.label.split()[-1]}$", result.units["value"]))
    ax.legend(loc="best")
