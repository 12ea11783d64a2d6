"""Forces on solids: each component on each body, next to what a balance expects."""

from __future__ import annotations

from typing import Any

import numpy as np

from mesokit.observe.result import Result
from mesokit.report.style import COLOURS, MARKERS, labelled

SHOWN = 12  # bodies in one figure


def draw(result: Result, figure: Any, ax: Any) -> None:
    """A panel for each component, as their sizes differ; in given axes the first alone."""
    names = [str(name) for name in result.x["component"]]
    if ax is not None:
        _panel(ax, result, 0)
        return
    rows = 1 if len(names) == 3 else 2
    panels = figure.subplots(rows, 3, sharex=True, squeeze=False).ravel()
    for column, panel in enumerate(panels):
        _panel(panel, result, column)
        panel.set_title(panel.get_ylabel(), fontsize=10)
        panel.set_ylabel("")
        if column < 3 * (rows - 1):
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=2)


def _panel(ax: Any, result: Result, column: int) -> None:
    bodies = [str(body) for body in result.x["body"]][:SHOWN]
    name, place, rows = str(result.x["component"][column]), np.arange(len(bodies)), len(bodies)
    axis = "xyz".index(name[1])
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    ax.errorbar(
        place, result.value[:rows, column], result.error[:rows, column], fmt=MARKERS[axis],
        mfc="white", color=COLOURS[axis], label="measured", zorder=3,
    )  # fmt: skip
    if result.expected is not None and np.isfinite(result.expected[:rows, column]).any():
        expected = result.expected[:rows, column]
        ax.hlines(expected, place - 0.35, place + 0.35, color="black", lw=1.5, label="theory")
    tilted = max(map(len, bodies)) * len(bodies) > 12
    ax.set_xticks(
        place, bodies, rotation=40 if tilted else 0, ha="right" if tilted else "center", fontsize=9
    )
    ax.set_xlabel("solid")
    ax.set_xlim(-0.6, len(bodies) - 0.4)
    ax.margins(y=0.15)
    kind = "force" if name[0] == "f" else "torque"
    ax.set_ylabel(labelled(f"{kind} ${name[0].upper()}_{name[1]}$", result.units[name]))
