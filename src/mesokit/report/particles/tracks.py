"""Molecules in time: size, orientation, place of their centres and velocity."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, LINES, labelled, time_axis
from mesokit.seam.result import Result

SHOWN = 6  # molecules with a line of their own
MORE = 2.4  # inches for four panels


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Panels of the first molecules in time; in given axes their radius of gyration alone."""
    if ax is not None:
        _lines(ax, result, "gyration", "radius of gyration $R_g$")
        ax.set_xlabel(labelled("time $t$", result.units["time"]))
        return
    names, axis = [str(name) for name in result.x["component"]], str(result.extra["axis"])
    wanted = [
        ("gyration", "radius of\ngyration $R_g$"),
        ("end-to-end", "end-to-end\ndistance $R$"),
        ("orientation", f"orientation\nalong ${axis}$"),
        (axis, f"centre ${axis}$"),
        (f"v{axis}", f"velocity $v_{axis}$"),
    ]
    known = np.any(np.isfinite(result.value), axis=(0, 1)).tolist()  # no place along sheared flow
    rows = [(name, label) for name, label in wanted if name in names and known[names.index(name)]]
    figure.set_figheight(figure.get_figheight() + MORE * (len(rows) - 2) / 3)
    panels = figure.subplots(len(rows), 1, sharex=True)
    for panel, (name, label) in zip(panels, rows, strict=True):
        _lines(panel, result, name, label)
        panel.yaxis.label.set_size(9)
        panel.locator_params(axis="y", nbins=4)
    time_axis(panels[-1], result.x["time"], result.units["time"])
    title = "molecule" if len(result.x["molecule"]) <= SHOWN else f"molecule (first {SHOWN})"
    legend_above(panels[0], title=title, handlelength=1.5)
    figure.align_ylabels()


def _lines(ax: Any, result: Result, name: str, label: str) -> None:
    """Draw one number of the first molecules, and its root mean square in theory."""
    column = [str(n) for n in result.x["component"]].index(name)
    for k, molecule in enumerate(result.x["molecule"][:SHOWN]):
        look: Any = {"color": COLOURS[k], "ls": LINES[k], "label": str(int(molecule))}
        ax.plot(result.x["time"], result.value[:, k, column], lw=0.9, **look)
    known = {"gyration": "ideal_gyration", "end-to-end": "ideal_end_to_end"}.get(name)
    if known and np.isfinite(result.extra[known]):
        ax.axhline(result.extra[known], color="black", lw=1.3, label="ideal: root mean square")
    ax.set_ylabel(labelled(label, result.units[name]))
