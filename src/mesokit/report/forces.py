"""Forces on solids: each component on each body, next to what a balance expects."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.shared.result import Result
from mesokit.report.style import COLOURS, MARKERS, labelled

SHOWN = 12  # bodies in one figure
MORE = 1.6  # inches for each further row


def draw(result: Result, figure: Any, ax: Any) -> None:
    """A panel for each component, as their sizes differ; in given axes the first alone.

    Plates have panels of their own: the fluid presses on them with far more than it gives to what
    stands in it. Their torques are left out.
    """
    names = [str(name) for name in result.x["component"]]
    plates = np.asarray(result.extra.get("plates", np.zeros(len(result.x["body"]), int)), bool)
    if ax is not None:
        _panel(ax, result, 0, np.arange(len(plates)))
        return
    forces = [k for k, name in enumerate(names) if name[0] == "f"]
    rows: list[tuple[NDArray[np.intp], list[int]]] = []
    solids, plain = np.flatnonzero(~plates), np.flatnonzero(plates)
    if len(solids):
        torques = [k for k in range(len(names)) if k not in forces]
        rows += [(solids, forces + torques)] if len(names) == 3 else [
            (solids, forces), (solids, torques)
        ]  # fmt: skip
    if len(plain):
        rows.append((plain, forces))
    figure.set_figheight(figure.get_figheight() + MORE * (len(rows) - 1))
    wide = max(len(columns) for _, columns in rows)
    panels = figure.subplots(len(rows), wide, squeeze=False)
    for (bodies, columns), row in zip(rows, panels, strict=True):
        for panel in row[len(columns) :]:
            panel.set_axis_off()
        for column, panel in zip(columns, row, strict=False):
            _panel(panel, result, column, bodies)
            title = panel.get_ylabel() + _about(result, bodies, names[column])
            panel.set_title(title, fontsize=10)
            panel.set_ylabel("")
    handles: dict[str, Any] = {}
    for panel in panels.ravel():
        handles = dict(zip(*panel.get_legend_handles_labels()[::-1], strict=True)) | handles
    figure.legend(handles.values(), handles, loc="outside upper center", ncols=2)


def _about(result: Result, bodies: NDArray[np.intp], name: str) -> str:
    """What a torque is about."""
    if name[0] == "f" or "pivot" not in result.extra:
        return ""
    if len(bodies) > 1:
        return "\nabout the centre of each"
    place = ", ".join(f"{x:.4g}" for x in result.extra["pivot"][bodies[0]])
    return f"\nabout ({place})"


def _panel(ax: Any, result: Result, column: int, chosen: NDArray[np.intp]) -> None:
    chosen = chosen[:SHOWN]
    bodies = [str(body) for body in result.x["body"][chosen]]
    name, place = str(result.x["component"][column]), np.arange(len(bodies))
    axis = "xyz".index(name[1])
    ax.axhline(0, color="0.6", lw=0.8, zorder=1)
    ax.errorbar(
        place,
        result.value[chosen, column],
        result.error[chosen, column],
        fmt=MARKERS[axis],
        mfc="white",
        color=COLOURS[axis],
        label=r"measured, $\pm$ one standard error",
        zorder=3,
    )
    if result.expected is not None and np.isfinite(result.expected[chosen, column]).any():
        expected = result.expected[chosen, column]
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
