"""Histograms beside their theory, and the ratio of both below."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_of
from mesokit.report.style import COLOURS, lettered
from mesokit.seam.result import Result

NOISY = 0.3  # relative error above which a ratio says nothing
LABELS = {"speed": r"|\mathbf{v}|", "number": "particles in a cell"}


def draw(result: Result, figure: Any, ax: Any) -> None:
    """A column for each histogram; in given axes the first alone, without the ratio."""
    if ax is not None:
        _histogram(ax, result, 0)
        ax.set_xlabel(_label(result, 0))
        ax.legend()
        return
    count = len(result.x["of"])
    panels = figure.subplots(2, count, squeeze=False, sharex="col", height_ratios=[3, 1])
    for k in range(count):
        _histogram(panels[0, k], result, k)
        _ratio(panels[1, k], result, k)
        panels[1, k].set_xlabel(_label(result, k))
        panels[0, k].set_ylabel(result.label if k == 0 else "")
    panels[1, 0].set_ylabel("measured\n/ theory")
    lettered(list(panels[0]))
    legend_of(figure, [panels[0, 0]])


def _label(result: Result, k: int) -> str:
    name = str(result.x["of"][k])
    label = LABELS.get(name, name)
    return rf"${label}\,/\,\sqrt{{k_BT/m}}$" if name != "number" else label


def _histogram(ax: Any, result: Result, k: int) -> None:
    edges, value, error = result.extra["edges"][k], result.value[k], result.error[k]
    middle = 0.5 * (edges[1:] + edges[:-1])
    ax.stairs(value, edges, fill=True, color=COLOURS[0], alpha=0.25)
    ax.errorbar(
        middle,
        value,
        error,
        fmt="o",
        ms=3,
        mfc="white",
        color=COLOURS[0],
        label=r"measured, $\pm$ one standard error",
    )
    if result.expected is not None and np.isfinite(result.expected[k]).any():
        ax.stairs(
            result.expected[k], edges, color="black", lw=1.3, label=f"theory: {result.theory}"
        )
    ax.set_xlim(edges[0], edges[-1])
    ax.set_ylim(bottom=0)
    ax.locator_params(axis="x", integer=True)


def _ratio(ax: Any, result: Result, k: int) -> None:
    ax.axhline(1, color="black", lw=1)
    if result.expected is None:
        return
    edges, expected = result.extra["edges"][k], result.expected[k]
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio, error = result.value[k] / expected, result.error[k] / expected
    use = (error < NOISY) & (error > 0)
    middle = 0.5 * (edges[1:] + edges[:-1])
    ax.errorbar(middle[use], ratio[use], error[use], fmt="o", ms=3, mfc="white", color=COLOURS[0])
