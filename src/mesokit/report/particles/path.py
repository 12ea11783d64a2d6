"""A number in time as a line, thin over the broad one of theory."""

from typing import Any

from mesokit.report.caption import mathematics
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, labelled
from mesokit.seam.result import Result


def draw(result: Result, figure: Any, ax: Any) -> None:
    """What was measured against time, and what theory expects."""
    ax = figure.subplots() if ax is None else ax
    time = result.x["time"]
    if result.expected is not None:
        theory = mathematics(f"theory: {result.theory}")
        ax.plot(time, result.expected, color="0.7", lw=3.5, label=theory, zorder=1)
    ax.plot(time, result.value, color=COLOURS[0], lw=1, label="measured", zorder=2)
    ax.set_xlabel(labelled("time $t$", result.units["time"]))
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    legend_above(ax)
