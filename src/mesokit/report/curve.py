"""Curves of any result: values over the first coordinate, on plain or logarithmic axes."""

import itertools
from typing import Any

import numpy as np

from mesokit.report.caption import mathematics
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import (
    COLOURS,
    LINES,
    MEASURED,
    labelled,
    points,
    sparse_logarithm,
    theory_of,
    time_axis,
)
from mesokit.seam.result import Result

SHOWN = 6  # curves
MANY = 200  # points of a line that is to look smooth
SPAN = 5.0  # largest over smallest structure factor from which axes are logarithmic
BESIDE = 0.15  # how far apart curves are beside a name, in distances of names
GUIDED = 4  # of the last points, through whose middle a guide goes


def draw(result: Result, ax: Any) -> None:
    """Data with error bars and theory, a curve for each choice of the other coordinates."""
    if not result.x:
        points(ax, [0], result.value, result.error)
        ax.set_xticks([0], [result.name])
        ax.set_ylabel(labelled(result.label, result.units.get("value", "")))
        return
    axis, *others = result.x
    x = np.asarray(result.x[axis])
    named = x.dtype.kind in "US"
    places = np.arange(len(x)) if named else x
    every = itertools.product(*(range(len(result.x[name])) for name in others))
    choices = list(itertools.islice(every, SHOWN))
    beside = [(i - (len(choices) - 1) / 2) * BESIDE for i in range(len(choices))]
    for i, chosen in enumerate(choices):
        at: Any = (slice(None), *chosen)
        picked = [(name, result.x[name][k]) for name, k in zip(others, chosen, strict=True)]
        label = ", ".join(f"{name} {value}".removeprefix("of ") for name, value in picked)
        usual = MEASURED if np.isfinite(result.error[at]).any() else "measured"
        here = places + beside[i] if named else places
        points(ax, here, result.value[at], result.error[at], i, lw=0.8, label=label or usual)
        if result.expected is not None and np.isfinite(result.expected[at]).any():
            of = [f"theory: {result.theory}", ", ".join(str(value) for _, value in picked)]
            theory = mathematics(", ".join(filter(None, of)))
            look = {"color": "black", "ls": LINES[i]}
            if named:  # no line joins names; one entry of the legend for all
                dash = {"ls": "none", "marker": "_", "ms": 24, "mew": 1.2, "color": look["color"]}
                ax.plot(here, result.expected[at], label=mathematics(of[0]), zorder=1, **dash)
            elif len(places) == 1:  # of which a line through all points shows nothing
                ax.axhline(result.expected[at][0], lw=1.2, label=theory, **look)
            else:
                ax.plot(places, result.expected[at], lw=1.2, label=theory, **look)
    if named:  # names need no label
        ax.set_xticks(places, [str(name) for name in x])
        ax.set_xlim(-0.5, len(x) - 0.5)  # so that names stay within
    else:
        ax.set_xlabel(labelled(axis, result.units.get(axis, "")))
    ax.set_ylabel(labelled(result.label, result.units.get("value", "")))
    legend_above(ax)


def draw_path(result: Result, ax: Any) -> None:
    """A number in time as a thin line over the broad one of theory, or several with their names."""
    time, several = result.x["time"], result.value.ndim == 2
    names = result.x[list(result.x)[1]] if several else ("measured",)
    columns = np.reshape(result.value, (len(time), -1)).T
    for k, (name, column) in enumerate(zip(names[:SHOWN], columns, strict=False)):
        if result.expected is not None:
            theory = theory_of(result) if k == 0 else None
            known = np.reshape(result.expected, (len(time), -1))[:, k]
            ax.plot(time, known, color="0.7", lw=3.5, label=theory, zorder=1)
        look: Any = {"color": COLOURS[k], "ls": LINES[k], "lw": 1, "zorder": 2}
        ax.plot(time, column, label=str(name), **look)
    time_axis(ax, time, result.units["time"])
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    legend_above(ax)


def draw_growth(result: Result, ax: Any) -> None:
    """Numbers in time on logarithmic axes, with bands of one standard error, and theory."""
    time = np.asarray(result.x["time"], float)
    names = result.x[list(result.x)[1]] if result.value.ndim == 2 else ("",)
    columns, bars = (np.reshape(array, (len(time), -1)) for array in (result.value, result.error))
    for k, name in enumerate(names[:SHOWN]):
        use = (time > 0) & (columns[:, k] > 0)
        value, error = columns[use, k], bars[use, k]
        band = {"color": COLOURS[k], "alpha": 0.25, "lw": 0}
        label = "one standard error" if k == 0 and np.isfinite(error).any() else None
        low = np.maximum(value - error, 0.1 * value)
        ax.fill_between(time[use], low, value + error, label=label, **band)
        words = f"measured by {name}" if name else "measured"
        ax.plot(time[use], value, LINES[k], color=COLOURS[k], lw=1, label=words, zorder=2)
        if result.expected is not None:
            wanted = np.reshape(result.expected, (len(time), -1))[use, k]
            look: Any = {"color": "black", "lw": 1.2, "ls": "--", "zorder": 3}
            if np.isfinite(wanted).any():
                ax.plot(time[use], wanted, label=theory_of(result), **look)
    if ax.lines and any(len(line.get_xdata()) for line in ax.lines):
        ax.set(xscale="log", yscale="log")
        sparse_logarithm(ax.xaxis, *ax.get_xlim())
        sparse_logarithm(ax.yaxis, *ax.get_ylim())
    ax.set_xlabel(labelled("time $t$", result.units["time"]))
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    legend_above(ax)


def draw_cooling(result: Result, ax: Any) -> None:
    """Temperatures in time on logarithmic axes, which have no place for those before the start.

    Theory is drawn at many times in equal ratios: the inverse root of Haff's law is linear in time.
    """
    before = len(ax.lines)
    draw(result, ax)
    time = result.x["time"]
    if len(time) > 1 and (result.value > 0).all():
        ax.set(yscale="log", xscale="log")
        ax.set_xlim(0.8 * time[time > 0].min(), 1.25 * time[-1])
        many = np.geomspace(max(ax.get_xlim()[0], time[0]), time[-1], MANY)
        for line in ax.lines[before:]:
            if str(line.get_label()).startswith("theory"):
                root = np.asarray(line.get_ydata(), float) ** -0.5
                line.set_data(many, np.interp(many, time, root) ** -2.0)


def draw_structure_factor(result: Result, ax: Any) -> None:
    """S(q), on logarithmic axes if it is far above 1 at long waves."""
    draw(result, ax)
    value = result.value[np.isfinite(result.value)]
    if len(value) and value.min() > 0 and value.max() > SPAN * value.min():
        ax.set(xscale="log", yscale="log")
        sparse_logarithm(ax.xaxis, *ax.get_xlim())
        sparse_logarithm(ax.yaxis, *ax.get_ylim())
    else:
        ax.set_ylim(bottom=0)


def draw_logarithmic(result: Result, ax: Any) -> None:
    """Values over the first coordinate on logarithmic axes, without those that are not above 0."""
    draw(result, ax)
    seen = result.value[np.isfinite(result.value) & (result.value > 0)]
    if len(seen):
        ax.set(xscale="log", yscale="log")
        ax.set_ylim(0.5 * seen.min(), 2 * seen.max())
        sparse_logarithm(ax.xaxis, *ax.get_xlim())
        sparse_logarithm(ax.yaxis, *ax.get_ylim())


def draw_number_fluctuations(result: Result, ax: Any) -> None:
    """Fluctuations of numbers over their means, birds at random, and the power of large ordered
    flocks in these."""
    slope, (mean,) = result.extra.get("guide", np.nan), result.x.values()
    x, y = np.asarray(mean, float), result.value
    ax.set(xscale="log", yscale="log")
    points(ax, x, y, result.error, lw=0.8, label=MEASURED)
    if result.expected is not None:
        birds = x[-1] ** 2 / (x[-1] - result.expected[-1] ** 2)  # which are n (1 - n/birds) there
        n = np.geomspace(x[0], x[-1], MANY)
        random = np.sqrt(n * (1 - n / birds))
        label = r"birds at random, $\sqrt{\langle n\rangle}$ in a large box"
        ax.plot(n[random > 0], random[random > 0], color="black", lw=1.2, label=label, zorder=1)
    last = slice(-GUIDED, None)
    if len(x) > 1 and np.isfinite(slope) and (y[last] > 0).all():
        middle, level = (np.exp(np.log(z[last]).mean()) for z in (x, y))
        ends = x[[0, -1]]
        label = rf"$\langle n\rangle^{{{slope:g}}}$ (Toner and Tu, ordered flocks)"
        guide = level * (ends / middle) ** slope
        ax.plot(ends, guide, "--", lw=1.2, color=COLOURS[1], label=label, zorder=1)
    sparse_logarithm(ax.xaxis, *ax.get_xlim())
    sparse_logarithm(ax.yaxis, *ax.get_ylim())
    ax.set_xlabel(labelled(r"mean number $\langle n\rangle$", ""))
    ax.set_ylabel(labelled(result.label, result.units.get("value", "")))
    legend_above(ax, 2)
