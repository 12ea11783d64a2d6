"""Any result: its values over the first coordinate, a curve for each choice of the others."""

import itertools
from typing import Any

import numpy as np

from mesokit.report.caption import mathematics
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, LINES, MARKERS, labelled
from mesokit.seam.result import Result

SHOWN = 6  # curves
BARS = r"measured, $\pm$ one standard error"


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Data with error bars, and theory where there is one: of several curves each has its own."""
    ax = figure.subplots() if ax is None else ax
    if not result.x:
        ax.errorbar([0], result.value, result.error, fmt="o", mfc="white", color=COLOURS[0])
        ax.set_xticks([0], [result.name])
        ax.set_ylabel(labelled(result.label, result.units.get("value", "")))
        return
    axis, *others = result.x
    x = np.asarray(result.x[axis])
    places = np.arange(len(x)) if x.dtype.kind in "US" else x
    choices = itertools.product(*(range(len(result.x[name])) for name in others))
    for i, chosen in enumerate(itertools.islice(choices, SHOWN)):
        at: Any = (slice(None), *chosen)
        label = ", ".join(
            f"{name} {result.x[name][k]}".removeprefix("of ")
            for name, k in zip(others, chosen, strict=True)
        )
        ax.errorbar(
            places,
            result.value[at],
            result.error[at],
            fmt=MARKERS[i],
            mfc="white",
            lw=0.8,
            color=COLOURS[i],
            label=label or (BARS if np.isfinite(result.error[at]).any() else "measured"),
            zorder=2,
        )
        if result.expected is not None and np.isfinite(result.expected[at]).any():
            of = ", ".join(str(result.x[name][k]) for name, k in zip(others, chosen, strict=True))
            theory = mathematics(", ".join(filter(None, [f"theory: {result.theory}", of])))
            look = {"color": "black", "ls": LINES[i]}
            if x.dtype.kind in "US":  # no line joins names
                dash = {"ls": "none", "marker": "_", "ms": 24, "mew": 1.2, "color": look["color"]}
                ax.plot(places, result.expected[at], label=theory, zorder=1, **dash)
            elif len(places) == 1:  # of which a line through all points shows nothing
                ax.axhline(result.expected[at][0], lw=1.2, label=theory, **look)
            else:
                ax.plot(places, result.expected[at], lw=1.2, label=theory, **look)
    if x.dtype.kind in "US":
        ax.set_xticks(places, [str(name) for name in x])
        ax.set_xlim(-0.5, len(x) - 0.5)  # so that names stay within
    else:  # names say themselves what they are
        ax.set_xlabel(labelled(axis, result.units.get(axis, "")))
    ax.set_ylabel(labelled(result.label, result.units.get("value", "")))
    legend_above(ax)
