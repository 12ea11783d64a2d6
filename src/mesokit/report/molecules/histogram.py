"""A probability density: steps with error bars, theory, and the mean."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, labelled
from mesokit.seam.result import Result

SYMBOLS = {"Rg": "$R_g$", "R": "$R$", "cosine": r"$\cos\theta$", "duration": "$t$"}


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Bins as a filled outline, their error bars, and what theory expects of each."""
    from mesokit.report.caption import mathematics

    ax = figure.subplots() if ax is None else ax
    (name, middle), edges = next(iter(result.x.items())), result.extra["edges"]
    words = str(result.extra["of"])
    symbol = SYMBOLS.get(name, f"${name[0]}_{name[1:]}$" if len(name) > 1 else f"${name}$")
    words = words.removesuffix(f" along {name}") if f" along {name}" in words else words
    ax.set_xlabel(labelled(f"{words} {symbol}", result.units[name]))
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    if not len(middle):
        ax.text(0.5, 0.5, "nothing has happened yet", ha="center", transform=ax.transAxes)
        return
    ax.stairs(result.value, edges, fill=True, color=COLOURS[0], alpha=0.2)
    ax.stairs(result.value, edges, color=COLOURS[0], lw=0.9, label="measured")
    ax.errorbar(
        middle,
        result.value,
        result.error,
        fmt="none",
        ecolor=COLOURS[0],
        elinewidth=0.9,
        label=r"$\pm$ one standard error" if np.isfinite(result.error).any() else None,
    )
    if result.expected is not None and np.isfinite(result.expected).any():
        theory = mathematics(f"theory: {result.theory}")
        ax.plot(middle, result.expected, color="black", lw=1.3, label=theory)
    if "beside" in result.extra:
        name = str(result.extra["beside_label"])
        ax.plot(middle, result.extra["beside"], ":", color=COLOURS[2], lw=1.8, label=name)
    mean = result.extra.get("mean", np.nan)
    if np.isfinite(mean):
        ax.axvline(mean, color=COLOURS[1], ls="--", lw=1.2, label="mean")
    ax.set_xlim(*(edges[[0, -1]] if len(middle) > 1 else (0, edges[0] + edges[-1])))
    ax.set_ylim(bottom=0)
    legend_above(ax)
