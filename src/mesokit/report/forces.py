"""Forces on solids: their components side by side, next to what a balance expects, and in time."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.report.finish.legend import legend_of
from mesokit.report.style import (
    COLOURS,
    ERROR,
    LINES,
    MARKERS,
    labelled,
    lettered,
    points,
    time_axis,
)
from mesokit.seam.result import Result

SHOWN = 12  # bodies in one figure
MORE = 1.7  # inches for each further row
PIECES = 120  # means that a force in time is drawn with

Places = NDArray[np.intp]


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Forces and torques, and in time those on the first solid; in given axes the forces alone.

    Plates have panels of their own, one for each component, as the pressure on them exceeds all
    forces on other solids. Their torques are left out.
    """
    names = [str(name) for name in result.x["component"]]
    plates = np.asarray(result.extra.get("plates", np.zeros(len(result.x["body"]), int)), bool)
    forces = [k for k, name in enumerate(names) if name[0] == "f"]
    torques = [k for k in range(len(names)) if k not in forces]
    if ax is not None:
        _panel(ax, result, forces, np.arange(len(plates)))
        ax.legend(loc="best")
        return
    solids, plain = np.flatnonzero(~plates), np.flatnonzero(plates)
    rows: list[list[tuple[Places, list[int]]]] = []
    if len(solids):
        rows.append([(solids, forces), (solids, torques)])
    if len(plain):
        rows.append([(plain, [k]) for k in forces])
    timed = len(solids) > 0 and len(result.extra.get("time", ())) > 2
    count = len(rows) + timed
    figure.set_figheight(figure.get_figheight() + MORE * (count - 1))
    parts = np.atleast_1d(figure.subfigures(count, 1))
    panels: list[Any] = []
    for part, row in zip(parts, rows, strict=False):
        drawn = part.subplots(1, len(row), squeeze=False)[0]
        panels += list(drawn)
        for panel, (bodies, columns) in zip(drawn, row, strict=True):
            _panel(panel, result, columns, bodies)
            title = panel.get_ylabel() + _about(result, bodies, names[columns[0]])
            panel.set_title(title, fontsize=10)
            panel.set_ylabel("")
    if timed:
        panels.append(parts[-1].subplots())
        _in_time(panels[-1], result, forces, int(solids[0]))
    lettered(panels)
    legend_of(figure, panels[: len(panels) - timed], title=ERROR)


def _about(result: Result, bodies: Places, name: str) -> str:
    """The point to which a torque refers, in words; nothing for a force."""
    if name[0] == "f" or "pivot" not in result.extra:
        return ""
    if len(bodies) > 1:
        return "\nabout the centre of each"
    place = ", ".join(f"{x:.4g}" for x in result.extra["pivot"][bodies[0]])
    return f"\nabout ({place})"


def _symbol(name: str) -> str:
    return f"${name[0].upper()}_{name[1]}$"


def _panel(ax: Any, result: Result, columns: list[int], chosen: Places) -> None:
    """Components side by side, body by body."""
    chosen = chosen[:SHOWN]
    bodies = [str(body) for body in result.x["body"][chosen]]
    names = [str(result.x["component"][k]) for k in columns]
    width = 0.7 / len(columns)
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    for number, (k, name) in enumerate(zip(columns, names, strict=True)):
        axis = "xyz".index(name[1])
        place = np.arange(len(bodies)) + (number - (len(columns) - 1) / 2) * width
        look = {"fmt": MARKERS[axis + 3 * (name[0] == "t")], "label": _symbol(name), "zorder": 3}
        points(ax, place, result.value[chosen, k], result.error[chosen, k], axis, **look)
        if result.expected is not None and np.isfinite(result.expected[chosen, k]).any():
            ends = place - width / 2, place + width / 2
            ax.hlines(result.expected[chosen, k], *ends, color="black", lw=1.5, label="theory")
    tilted = max(map(len, bodies)) * len(bodies) > 12
    turned = {"rotation": 40, "ha": "right"} if tilted else {"rotation": 0, "ha": "center"}
    ax.set_xticks(np.arange(len(bodies)), bodies, fontsize=9, **turned)
    ax.set_xlim(-0.6, len(bodies) - 0.4)
    ax.margins(y=0.15)
    kind = "force" if names[0][0] == "f" else "torque"
    letters = ", ".join(map(_symbol, names))
    ax.set_ylabel(labelled(f"{kind} {letters}", result.units[names[0]]))


def _in_time(ax: Any, result: Result, columns: list[int], body: int) -> None:
    """The force on a body, in means over parts of the run; its coefficient at the right."""
    time, series = result.extra["time"], result.extra["series"][:, body]
    size = -(-len(time) // PIECES)
    count = len(time) // size
    time, series = (
        a[: count * size].reshape(count, size, *a.shape[1:]).mean(axis=1) for a in (time, series)
    )
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    for number, k in enumerate(columns):
        name = str(result.x["component"][k])
        style = {"ls": LINES[number], "color": COLOURS["xyz".index(name[1])]}
        ax.plot(time, series[:, k], lw=1, label=_symbol(name), **style)
    time_axis(ax, time, "tau")
    ax.set_ylabel(labelled(f"force on {result.x['body'][body]}", result.units["fx"]))
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=len(columns), borderaxespad=0.2)
    scale = result.extra.get("coefficient", np.nan)
    if np.isfinite(scale) and scale:
        right = ax.secondary_yaxis("right", functions=(lambda f: f * scale, lambda c: c / scale))
        right.set_ylabel("coefficient $C$")
        ax.tick_params(right=False)
