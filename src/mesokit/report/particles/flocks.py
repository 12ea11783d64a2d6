"""What is measured of flocks: order in time, bands, clusters."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, LINES, labelled
from mesokit.seam.result import Result

MEASURED = r"measured, $\pm$ one standard error"


def draw_order(result: Result, figure: Any, ax: Any) -> None:
    """The order in time with its mean, and the mean heading below."""
    below = None
    if ax is None:
        ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    time, mean, error = result.x["time"], result.extra["mean"], result.extra["mean_error"]
    ax.plot(time, result.value, color=COLOURS[0], lw=0.8, label="measured")
    if np.isfinite(mean):
        known = np.isfinite(error)
        label = r"mean, $\pm$ one standard error" if known else "mean"
        ax.axhline(mean, color=COLOURS[1], ls="--", lw=1.3, label=label)
        if known:
            ax.axhspan(mean - error, mean + error, color=COLOURS[1], alpha=0.25, lw=0)
    if result.expected is not None and len(time):
        label = f"theory: {result.theory}"
        ax.axhline(result.expected[0], color="black", lw=1.5, label=label)
    ax.set_ylabel(labelled(r"polar order $\phi$", result.units["value"]))
    ax.set_ylim(0, max(1.0, 1.02 * float(np.max(result.value, initial=0.0))))
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    legend_above(ax)
    if below is not None:
        for k, row in enumerate(np.reshape(result.extra["heading"], (len(time), -1)).T):
            style: Any = {"color": COLOURS[k], "ls": LINES[k], "lw": 0.8}
            below.plot(time, row, label=f"${'xyz'[k]}$", **style)
        below.set_ylabel("mean heading")
        below.set_ylim(-1.05, 1.05)
        below.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    (below or ax).set_xlabel(labelled("time $t$", result.units["time"]))


def draw_bands(result: Result, figure: Any, ax: Any) -> None:
    """Density over its mean, and the mean heading along the axis below."""
    below = None
    if ax is None:
        ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    along = result.x["along"]
    for panel, column, label in (
        (ax, 0, "density / its mean"),
        (below, 1, "heading\nalong the axis"),
    ):
        if panel is None:
            continue
        panel.errorbar(
            along,
            result.value[:, column],
            result.error[:, column],
            fmt="o",
            mfc="white",
            ms=3,
            lw=0.8,
            capsize=0,
            color=COLOURS[0],
            label=MEASURED,
        )
        panel.set_ylabel(label)
        panel.set_ylim(bottom=0)
    ax.axhline(1, color="black", lw=1, ls=":")
    ax.set_xlim(0, along[0] + along[-1])
    legend_above(ax)
    (below or ax).set_xlabel(
        labelled("place along the flight, crest in the middle", result.units["along"])
    )


def draw_clusters(result: Result, figure: Any, ax: Any) -> None:
    """Shares of the birds as steps, sizes doubling from one to the next."""
    ax = figure.subplots() if ax is None else ax
    size, value = result.x["size"], result.value
    ax.stairs(value, np.append(size, 2 * size[-1]), color=COLOURS[0], fill=False, lw=1.2)
    middle = np.sqrt(2.0) * size
    ax.errorbar(middle, value, result.error, fmt="o", mfc="white", color=COLOURS[0], label=MEASURED)
    ax.set_xscale("log")
    ax.set_ylim(bottom=0)
    ax.set_xlabel("birds in a cluster")
    ax.set_ylabel("share of the birds")
    legend_above(ax)
