"""Time series of what should be conserved: what changed since the first sample."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.observe.shared.result import Result
from mesokit.report.style import COLOURS, LINES, labelled


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Momentum, kinetic energy and temperature in time; in given axes the temperature alone."""
    time, names = result.x["time"], [str(name) for name in result.x["component"]]
    if ax is not None:
        _one(result, ax, names.index("temperature"), "temperature\n$k_BT$")
        ax.set_xlabel(labelled("time $t$", result.units["time"]))
        return
    top, middle, bottom = figure.subplots(3, 1, sharex=True)
    momenta = [i for i, name in enumerate(names) if name.startswith("momentum")]
    for line, i in enumerate(momenta):
        change = result.value[:, i] - result.value[:1, i]
        top.plot(time, change, ls=LINES[line], color=COLOURS[line], lw=1, label=f"${names[i][-1]}$")
    top.set_ylabel(labelled("momentum\nchange", result.units[names[momenta[0]]]))
    top.legend(loc="upper left", ncols=3)
    energy = result.value[:, names.index("kinetic_energy")]
    first = energy[0] if len(energy) and energy[0] else 1.0
    middle.plot(time, energy / first - 1, color=COLOURS[0], lw=1)
    middle.set_ylabel("kinetic energy\nrelative change")
    _one(result, bottom, names.index("temperature"), "temperature\n$k_BT$")
    bottom.set_xlabel(labelled("time $t$", result.units["time"]))
    for panel in (top, middle):
        panel.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3))
    bottom.ticklabel_format(axis="y", useOffset=False)
    if len(time) > 1:
        bottom.set_xlim(time[0], time[-1])
    for panel in (top, middle, bottom):
        panel.yaxis.label.set_size(9)
    figure.align_ylabels()


def draw_flow(result: Result, figure: Any, ax: Any) -> None:
    """Mean velocity in time, its average with the error as a band, and the theory."""
    ax = figure.subplots() if ax is None else ax
    time, mean, error = result.x["time"], result.extra["mean"], result.extra["mean_error"]
    ax.plot(time, result.value, color=COLOURS[0], lw=0.8, label="measured")
    label = r"mean, $\pm$ one standard error" if np.isfinite(error) else "mean"
    ax.axhline(mean, color=COLOURS[1], ls="--", lw=1.3, label=label)
    if np.isfinite(error):
        ax.axhspan(mean - error, mean + error, color=COLOURS[1], alpha=0.25, lw=0)
    if result.expected is not None and len(time):
        ax.axhline(
            result.expected[0], color="black", lw=1.5, label=f"theory: {_pretty(result.theory)}"
        )
    ax.set_xlabel(labelled("time $t$", result.units["time"]))
    ax.set_ylabel(labelled(f"mean velocity along ${result.extra['axis']}$", result.units["value"]))
    if len(time) > 1:
        ax.set_xlim(time[0], time[-1])
    ax.legend(loc="best")


def _pretty(theory: str) -> str:
    names = {"hagen-poiseuille": "Hagen-Poiseuille", "poiseuille": "Poiseuille, no slip"}
    return names.get(theory, theory)


def _one(result: Result, ax: Any, index: int, label: str) -> None:
    value, expected = result.value[:, index], result.expected
    ax.plot(result.x["time"], value, color=COLOURS[0], lw=0.8, label="measured")
    if expected is not None and np.isfinite(expected[:, index]).any():
        ax.plot(result.x["time"], expected[:, index], color="black", lw=1.3, label="expected")
        level = float(np.nanmean(expected[:, index]))
        reach = 1.6 * max(float(np.nanmax(abs(value - level))), 1e-3 * abs(level))
        ax.set_ylim(level - reach, level + reach)
    ax.set_ylabel(labelled(label, result.units[str(result.x["component"][index])]))
    ax.legend(loc="upper left", ncols=2)
