"""Mean velocity and mean angular velocity of bodies, side by side, each with its unit."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import MEASURED, labelled, points
from mesokit.seam.result import Result

ROOM = 0.6  # beside the first and the last name, in distances of names


def draw(result: Result, figure: Any, ax: Any) -> None:
    """A panel of velocities and one of angular velocities; in given axes velocities alone."""
    names = np.array([str(name) for name in result.x["component"]])
    spins = np.char.startswith(names, "spin")
    if ax is not None:
        _panel(ax, result, names, ~spins)
        legend_above(ax)
        return
    counts = [int((~spins).sum()), int(spins.sum())]
    left, right = figure.subplots(1, 2, width_ratios=[count + ROOM for count in counts])
    _panel(left, result, names, ~spins)
    _panel(right, result, names, spins)
    legend_above(left)


def _panel(ax: Any, result: Result, names: Any, use: Any) -> None:
    """Some of the components, which have one unit."""
    first, places = str(names[use][0]), np.arange(int(use.sum()))
    turns = first.startswith("spin")
    ax.axhline(0, color="0.6", lw=0.8, zorder=0)
    points(ax, places, result.value[use], result.error[use], label=MEASURED)
    shown = [f"about {name[-1]}" if turns else name for name in names[use]]
    ax.set_xticks(places, shown)
    ax.set_xlim(-ROOM, len(places) - 1 + ROOM)
    label = "mean angular velocity" if turns else result.label
    ax.set_ylabel(labelled(label, result.units[first]))
