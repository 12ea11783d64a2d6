"""Temperatures in time on logarithmic axes, on which power laws are straight."""

from typing import Any

import numpy as np

from mesokit.report import curve
from mesokit.seam.result import Result

MANY = 200  # points of a line that is to look smooth


def draw(result: Result, figure: Any, ax: Any) -> None:
    """The curves of any result; what has not begun at time 0 has no place on the axis."""
    ax = figure.subplots() if ax is None else ax
    before = len(ax.lines)
    curve.draw(result, figure, ax)
    time = result.x["time"]
    if len(time) > 1 and (result.value > 0).all():
        ax.set_yscale("log")
        ax.set_xscale("log")
        ax.set_xlim(0.8 * time[time > 0].min(), 1.25 * time[-1])
        for line in ax.lines[before:]:
            if str(line.get_label()).startswith("theory"):
                line.set_data(*_between(time, line.get_ydata(), ax.get_xlim()[0]))


def _between(time: Any, temperature: Any, least: float) -> tuple[Any, Any]:
    """Haff's law at many times in equal ratios: its inverse root is linear in time."""
    many = np.geomspace(max(least, time[0]), time[-1], MANY)
    return many, np.interp(many, time, np.asarray(temperature, float) ** -0.5) ** -2.0
