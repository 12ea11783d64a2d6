"""Snapshots: positions above, velocities below, a column for each step."""

from typing import Any

import numpy as np

from mesokit.report.caption import rounded, symbols
from mesokit.report.finish.legend import legend_of
from mesokit.report.style import COLOURS, labelled
from mesokit.seam.result import Result

TALL = 2.0  # most of the height of a panel over its width
MANY = 5000  # dots, beyond which a vector file holds an image of them


def draw(result: Result, figure: Any, ax: Any) -> None:
    """A scatter plot for each; in given axes the last positions alone."""
    steps, names = result.x["step"], [str(name) for name in result.x["component"]]
    if ax is not None:
        if len(steps):
            _scatter(ax, result, -1, 0, names)
        return
    count = max(len(steps), 1)
    spans = [np.subtract(*_ends(result, first)) for first in (0, 2)]
    ratios = [min(float(y / x), TALL) for x, y in spans]  # heights over widths of panels
    side = (figure.get_figwidth() - 0.8) / max(count, 2)  # of a panel
    figure.set_figheight(figure.get_figheight() - 4.8 + 0.9 + sum(ratios) * side)
    panels = figure.subplots(2, count, squeeze=False, height_ratios=ratios)
    for k, step in enumerate(steps):
        for row in range(2):
            _scatter(panels[row, k], result, k, 2 * row, names)
            if k:
                panels[row, k].set_ylabel("")
        word = "step" if step == 1 else "steps"
        time = f"{rounded(result.extra['time'][k])}\\,{symbols(result.units['time'])[1:-1]}"
        panels[0, k].set_title(f"{step} {word}, $t = {time}$", fontsize=10)
    legend_of(figure, [panels[0, 0]])


def _ends(result: Result, first: int) -> tuple[Any, Any]:
    """Lower and upper ends of both axes: around the box and all steps, a square of velocities."""
    values = result.value[:, :, first : first + 2].reshape(-1, 2)
    if first == 0:
        values = np.concatenate([values, [[0.0, 0.0]], [result.extra["size"]]])
    low, high = values.min(axis=0), values.max(axis=0)
    longest = float((high - low).max() or 1.0)
    half = 0.53 * longest if first else 0.5 * (high - low) + 0.03 * longest
    return (low + high) / 2 - half, (low + high) / 2 + half


def _scatter(ax: Any, result: Result, k: int, first: int, names: list[str]) -> None:
    """Positions (first = 0) or velocities (first = 2) of one step."""
    x, y = result.value[k, :, first], result.value[k, :, first + 1]
    size = float(np.clip(60.0 / np.sqrt(max(len(x), 1)), 0.5, 3.0))
    species = result.extra.get("species", np.zeros(len(x), int))
    several = len(np.unique(species)) > 1  # each has a colour of its own
    for kind in np.unique(species):
        colour = COLOURS[(kind if several else first // 2) % len(COLOURS)]
        of = species == kind
        ax.plot(x[of], y[of], "o", ms=size, mew=0, color=colour, rasterized=len(x) > MANY)
        if several:
            ax.plot([], [], "o", ms=4, mew=0, color=colour, label=f"species {kind + 1}")
    unit = result.units["velocity" if first else "position"]
    ax.set_xlabel(labelled(f"${names[first]}$", unit))
    ax.set_ylabel(labelled(f"${names[first + 1]}$", unit))
    low, high = _ends(result, first)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    if first == 0:  # where the box is, or was
        width, height = result.extra["size"]
        ax.plot([0, width, width, 0, 0], [0, 0, height, height, 0], "--", color="black", lw=0.8)
