"""Stress in time under the shear rate that causes it, as rheometers draw it."""

from typing import Any

import numpy as np

from mesokit.report.caption import mathematics
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, ERROR, LINES, labelled, points
from mesokit.seam.result import Result

SYMBOLS = {
    "shear stress": r"$\sigma_{xy}$",
    "shear stress of bonds": r"$\sigma_{xy}$ of bonds",
    "first normal-stress difference": r"$\sigma_{xx} - \sigma_{yy}$",
}
MORE = 1.4  # inches for three panels


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Shear rate, shear stress, normal stress; in given axes the shear stress alone."""
    names = [str(name) for name in result.x["component"]]
    if ax is not None:
        _curves(result, ax, names[:-1])
        ax.set_xlabel(labelled("time $t$", result.units["time"]))
        legend_above(ax)
        return
    figure.set_figheight(figure.get_figheight() + MORE)
    rate, shear, normal = figure.subplots(3, 1, sharex=True, height_ratios=[1, 3, 2])
    step = {"drawstyle": "steps-mid", "color": COLOURS[5], "lw": 1.2}
    rate.plot(result.x["time"], result.extra["rate"], **step)
    rate.set_ylabel(labelled(r"$\dot\gamma$", "1/tau"))
    _curves(result, shear, names[:-1])
    _curves(result, normal, names[-1:], first=len(names) - 1)
    normal.set_xlabel(labelled("time $t$", result.units["time"]))
    legend_above(shear)
    figure.align_ylabels()


def _curves(result: Result, ax: Any, names: list[str], first: int = 0) -> None:
    """Draw points, with error bars if known, and theory."""
    time = result.x["time"]
    for k, name in enumerate(names, start=first):
        value, error = result.value[:, k], result.error[:, k]
        known = bool(np.isfinite(error).any())
        label = SYMBOLS[name] + f", {ERROR}" * (known and not k)
        points(ax, time, value, error if known else None, k, ms=3, lw=0.8, label=label)
        if result.expected is not None:
            of = f" of {SYMBOLS[name]}" if len(names) > 1 else ""
            theory = mathematics(f"theory: {result.theory}{of}") if first == 0 else None
            look: Any = {"color": "black", "lw": 1.2, "ls": LINES[k - first], "zorder": 3}
            ax.plot(time, result.expected[:, k], label=theory, **look)
    ax.axhline(0, color="0.7", lw=0.7, zorder=1)
    ax.set_ylabel(labelled(SYMBOLS[names[0]], result.units["value"]))
