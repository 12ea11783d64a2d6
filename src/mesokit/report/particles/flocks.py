"""Figures of flocks: order in time, bands, clusters."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, LINES, MEASURED, labelled, mean_line, points, time_axis
from mesokit.seam.result import Result


def draw_order(result: Result, figure: Any, ax: Any) -> None:
    """Orders in time with their means, and the mean heading below."""
    below = None
    if ax is None:
        ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    time = result.x["time"]
    names = [str(name) for name in result.x.get("order", ("polar",))]
    columns = result.value.reshape(len(time), len(names)).T
    means, errors = (np.ravel(result.extra[key]) for key in ("mean", "mean_error"))
    for k, (name, column) in enumerate(zip(names, columns, strict=True)):
        several = len(names) > 1
        look: Any = {"color": COLOURS[2 * k], "ls": LINES[k], "lw": 0.8}
        ax.plot(time, column, label=name if several else "measured", **look)
        if np.isfinite(means[k]):
            label = f"mean of {name}" if several else "mean"
            mean_line(ax, means[k], errors[k], label, number=2 * k + 1)
    if result.expected is not None and len(time):
        label = f"theory: {result.theory}"
        ax.axhline(result.expected[0], color="black", lw=1.5, label=label)
    label = "order" if len(names) > 1 else r"polar order $\phi$"
    ax.set_ylabel(labelled(label, result.units["value"]))
    ax.set_ylim(0, max(1.0, 1.02 * float(np.max(result.value, initial=0.0))))
    legend_above(ax)
    if below is not None:
        for k, row in enumerate(np.reshape(result.extra["heading"], (len(time), -1)).T):
            style: Any = {"color": COLOURS[k], "ls": LINES[k], "lw": 0.8}
            below.plot(time, row, label=f"${'xyz'[k]}$", **style)
        below.set(ylabel="mean heading", ylim=(-1.05, 1.05))
        below.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    time_axis(below or ax, time, result.units["time"])


def draw_bands(result: Result, figure: Any, ax: Any) -> None:
    """Density over its mean, and the mean heading along the axis below."""
    along, panels = result.x["along"], [ax]
    if ax is None:
        panels = list(figure.subplots(2, 1, sharex=True, height_ratios=[2, 1]))
    labels = ("density / its mean", "heading\nalong the axis")
    for column, (panel, label) in enumerate(zip(panels, labels, strict=False)):
        value, error = result.value[:, column], result.error[:, column]
        points(panel, along, value, error, ms=3, lw=0.8, capsize=0, label=MEASURED)
        panel.set_ylabel(label)
        panel.set_ylim(bottom=0)
    panels[0].axhline(1, color="black", lw=1, ls=":")
    panels[0].set_xlim(0, along[0] + along[-1])
    legend_above(panels[0])
    label = "place along the flight, crest in the middle"
    panels[-1].set_xlabel(labelled(label, result.units["along"]))


def draw_clusters(result: Result, ax: Any) -> None:
    """Shares of the birds as steps, with sizes that double from one to the next."""
    size, value = result.x["size"], result.value
    ax.stairs(value, np.append(size, 2 * size[-1]), color=COLOURS[0], fill=False, lw=1.2)
    points(ax, np.sqrt(2.0) * size, value, result.error, label=MEASURED)
    ax.set_xscale("log")
    ax.set_ylim(bottom=0)
    ax.set(xlabel="birds in a cluster", ylabel="share of the birds")
    legend_above(ax)
