"""Temperatures in time on logarithmic axes, on which power laws are straight."""

from __future__ import annotations

from typing import Any

from mesokit.report import curve
from mesokit.seam.result import Result


def draw(result: Result, figure: Any, ax: Any) -> None:
    """The curves of any result; what has not begun at time 0 has no place on the axis."""
    ax = figure.subplots() if ax is None else ax
    curve.draw(result, figure, ax)
    time = result.x["time"]
    if len(time) > 1 and (result.value > 0).all():
        ax.set_yscale("log")
        ax.set_xscale("log")
        ax.set_xlim(0.8 * time[time > 0].min(), 1.25 * time[-1])
