"""Probability densities: one with its mean, or several over the ratio to their theory."""

from typing import Any

import numpy as np

from mesokit.report.finish.legend import legend_above, legend_of
from mesokit.report.style import COLOURS, ERROR, MEASURED, labelled, lettered, points, theory_of
from mesokit.seam.result import Result

SYMBOLS = {
    "dh": r"$\Delta h$",
    "Rg": "$R_g$",
    "R": "$R$",
    "cosine": r"$\cos\theta$",
    "duration": "$t$",
    "force": r"$f\,/\,\langle f\rangle$",
    "mobilisation": r"$|\mathbf{t}|\,/\,\mu f$",
    "contacts": "$z$",
}
NOISY = 0.3  # relative error above which a ratio says nothing


def draw(result: Result, ax: Any) -> None:
    """Bins as a filled outline with error bars, their theory, and the mean."""
    (name, middle), edges = next(iter(result.x.items())), result.extra["edges"]
    symbol = SYMBOLS.get(name, f"${name[0]}_{name[1:]}$" if len(name) > 1 else f"${name}$")
    words = str(result.extra["of"]).removesuffix(f" along {name}")
    ax.set_xlabel(labelled(f"{words} {symbol}", result.units[name]))
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    if not len(middle):
        ax.text(0.5, 0.5, "nothing has happened yet", ha="center", transform=ax.transAxes)
        return
    ax.stairs(result.value, edges, fill=True, color=COLOURS[0], alpha=0.2)
    ax.stairs(result.value, edges, color=COLOURS[0], lw=0.9, label="measured")
    bars = {"fmt": "none", "ecolor": COLOURS[0], "elinewidth": 0.9}
    label = ERROR if np.isfinite(result.error).any() else None
    ax.errorbar(middle, result.value, result.error, label=label, **bars)
    if result.expected is not None and np.isfinite(result.expected).any():
        look: Any = {"color": "black", "lw": 1.3, "label": theory_of(result)}
        if result.extra.get("discrete"):  # no line joins values between which there are none
            look |= {"ls": "none", "marker": "_", "ms": 18, "mew": 1.5}
        ax.plot(middle, result.expected, **look)
    if "beside" in result.extra:
        label = str(result.extra["beside_label"])
        ax.plot(middle, result.extra["beside"], ":", color=COLOURS[2], lw=1.8, label=label)
    mean = result.extra.get("mean", np.nan)
    if np.isfinite(mean):
        ax.axvline(mean, color=COLOURS[1], ls="--", lw=1.2, label="mean")
    ax.set_xlim(*(edges[[0, -1]] if len(middle) > 1 else (0, edges[0] + edges[-1])))
    ax.set_ylim(bottom=0)
    if result.extra.get("logarithmic"):
        _logarithmic(ax, result)
    legend_above(ax)


def _logarithmic(ax: Any, result: Result) -> None:
    """A logarithmic axis of densities from half of the least that is not 0."""
    some = result.value[result.value > 0]
    if len(some):
        ax.set_yscale("log")
        ax.set_ylim(0.5 * some.min(), 2.0 * some.max())


def draw_several(result: Result, figure: Any, ax: Any) -> None:
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
    if name == "number":
        return "particles in a cell"
    symbol = r"|\mathbf{v}|" if name == "speed" else name
    return rf"${symbol}\,/\,\sqrt{{k_BT/m}}$"


def _histogram(ax: Any, result: Result, k: int) -> None:
    edges, value = result.extra["edges"][k], result.value[k]
    ax.stairs(value, edges, fill=True, color=COLOURS[0], alpha=0.25)
    points(ax, 0.5 * (edges[1:] + edges[:-1]), value, result.error[k], ms=3, label=MEASURED)
    if result.expected is not None and np.isfinite(result.expected[k]).any():
        label = f"theory: {result.theory}"
        ax.stairs(result.expected[k], edges, color="black", lw=1.3, label=label)
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
    points(ax, 0.5 * (edges[1:] + edges[:-1])[use], ratio[use], error[use], ms=3)
