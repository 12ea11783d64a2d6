"""Bodies in time: their paths, how far they have turned, how fast they move and turn."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, LINES, labelled
from mesokit.seam.result import Result

SHOWN = 6  # bodies with a line of their own
MORE = 1.6  # inches for the panels below the paths


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Paths of the first bodies, and panels of them in time; in given axes the paths alone."""
    if ax is not None:
        _paths(ax, result)
        return
    figure.set_figheight(figure.get_figheight() + MORE)
    panels = figure.subplots(2, 2)
    _paths(panels[0, 0], result)
    names = [str(name) for name in result.x["component"]]
    flat = "angle" in names
    turned = "turn since the start" if flat else "turn about $z$ since the start"
    for panel, name, label in (
        (panels[0, 1], "angle" if flat else "angle z", f"{turned}  [rad]"),
        (panels[1, 0], "vx", "velocity $v_x$"),
        (panels[1, 1], "spin" if flat else "spin z", r"angular velocity $\Omega_z$"),
    ):
        for k, line in _lines(result, names.index(name)):
            panel.plot(result.x["time"], line, lw=0.9, color=COLOURS[k], ls=LINES[k])
        panel.set_xlabel(labelled("time $t$", result.units["time"]))
        panel.set_ylabel(labelled(label, result.units[name]))


def _paths(ax: Any, result: Result) -> None:
    """Paths in the plane of x and y, each from a dot; along a sheared flow y in time."""
    names = [str(name) for name in result.x["component"]]
    first, second = names.index("x"), names.index("y")
    known = bool(np.any(np.isfinite(result.value[:, :, first])))
    for (k, x), (_, y) in zip(_lines(result, first), _lines(result, second), strict=True):
        across = x if known else result.x["time"]
        look: Any = {"color": COLOURS[k], "label": str(int(result.x["body"][k]))}
        ax.plot(across, y, lw=0.9, ls=LINES[k], **look)
        ax.plot(across[:1], y[:1], "o", ms=3, color=COLOURS[k])
    if known:
        ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel(
        labelled("$x$", result.units["x"]) if known else labelled("time $t$", result.units["time"])
    )
    ax.set_ylabel(labelled("$y$", result.units["y"]))
    title = "body" if len(result.x["body"]) <= SHOWN else f"body (first {SHOWN})"
    legend_above(ax, title=title, handlelength=1.5)


def _lines(result: Result, column: int) -> list[tuple[int, Any]]:
    """One number of the first bodies in time."""
    return [(k, result.value[:, k, column]) for k in range(len(result.x["body"][:SHOWN]))]
