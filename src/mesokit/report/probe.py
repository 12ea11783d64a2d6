"""Velocity at a place: in time above, its power spectrum below."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, labelled, sparse_logarithm
from mesokit.seam.result import Result


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Time series and spectrum; in given axes the time series alone."""
    bottom = None
    if ax is None:
        ax, bottom = figure.subplots(2, 1, height_ratios=[2, 3])
    time, letter = result.extra["time"], result.extra["component"]
    ax.plot(time, result.extra["velocity"][:, "xyz".index(letter)], color=COLOURS[0], lw=0.8)
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    ax.set_xlabel(labelled("time $t$", result.units["time"]))
    ax.set_ylabel(labelled(f"velocity $v_{letter}$", result.units["velocity"]))
    if bottom is None:
        return
    frequency, use = result.x["frequency"], result.value > 0
    bottom.set_xlabel(labelled("frequency $f$", result.units["frequency"]))
    bottom.set_ylabel(labelled(f"power of $v_{letter}$", result.units["value"]))
    if not use.any():
        bottom.text(0.5, 0.5, "too few samples", ha="center", transform=bottom.transAxes)
        return
    low = np.maximum(result.value - result.error, 1e-3 * result.value)
    bottom.fill_between(
        frequency[use],
        low[use],
        (result.value + result.error)[use],
        color=COLOURS[0],
        alpha=0.25,
        lw=0,
        label="one standard error",
    )
    bottom.plot(frequency[use], result.value[use], color=COLOURS[0], lw=1.2, label="measured")
    if np.isfinite(result.extra["dominant"]):
        bottom.axvline(
            result.extra["dominant"], color=COLOURS[1], ls="--", lw=1.3, label="dominant frequency"
        )
    bottom.set_xscale("log")
    bottom.set_yscale("log")
    sparse_logarithm(bottom.xaxis, frequency[use][0], frequency[use][-1])
    sparse_logarithm(bottom.yaxis, float(low[use].min()), float(result.value[use].max()))
    legend_above(bottom)
