"""Profiles over their deviations from theory, and the profile along the wake of a body."""

from typing import Any

import numpy as np

from mesokit.report.caption import mathematics
from mesokit.report.finish.legend import legend_above
from mesokit.report.style import COLOURS, MEASURED, labelled, points
from mesokit.seam.result import Result

AXES = {"r": "distance from the axis $r$", "distance": "distance from the surface"}
NAMES = {
    "poiseuille": "Poiseuille, no slip",
    "half poiseuille": "Poiseuille, one slip plate",
    "couette": "Couette, no slip",
    "lees-edwards": "uniform shear",
    "kolmogorov": "Kolmogorov",
    "hagen-poiseuille": "Hagen-Poiseuille, no slip",
    "taylor-couette": "Taylor-Couette, no slip",
    "drum": "turning as one",
    "drift": "the drift of all",
}


def draw(result: Result, figure: Any, ax: Any) -> None:
    """Draw a profile; the panel of deviations only in a figure of its own."""
    (axis, x), residuals = next(iter(result.x.items())), None
    steady = all(comparison.steady for comparison in result.comparisons)
    known = result.expected is not None and np.isfinite(result.expected).any()
    if ax is None and known and steady:
        ax, residuals = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
    elif ax is None:
        ax = figure.subplots()
    many = len(x) > 150
    look = {"ms": 2 if len(x) > 60 else 4, "capsize": 0 if many else 2}
    points(ax, x, result.value, result.error, lw=0.8, label=MEASURED, **look)
    if known:
        label = mathematics(f"theory: {NAMES.get(result.theory, result.theory)}")
        ax.plot(x, result.expected, color="black", lw=1.5, label=label, zorder=3)
    raised = result.extra.get("raised")
    if raised is not None:
        label = f"viscosity up to {float(result.extra['raised_by']):.1f} % higher"
        ax.fill_between(x, raised, result.expected, color=COLOURS[2], alpha=0.3, lw=0, label=label)
    if result.fit is not None:
        ax.plot(x, result.fit, "--", color=COLOURS[1], lw=1.3, label="fit", zorder=4)
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    _frame(ax, result)
    legend_above(ax, columns=3 if raised is None else 2)
    if residuals is not None:
        deviation = result.deviation
        residuals.axhline(0, color="black", lw=1)
        residuals.axhspan(-1, 1, color="0.88", lw=0)
        residuals.plot(x, deviation, "o", mfc="white", color=COLOURS[0], ms=2 if many else 3)
        if raised is not None and result.expected is not None:
            with np.errstate(divide="ignore", invalid="ignore"):
                lower = (raised - result.expected) / result.error
            residuals.fill_between(x, lower, 0 * x, color=COLOURS[2], alpha=0.3, lw=0)
        residuals.set_ylabel("deviation\n[s.e.]")
        finite = abs(deviation[np.isfinite(deviation)]) if deviation is not None else np.zeros(0)
        reach = max(3.5, 1.15 * finite.max()) if len(finite) else 3.5
        residuals.set_ylim(-reach, reach)
    edges = result.extra.get("edges", np.array([0, x[-1] + x[0]]))
    bottom = ax if residuals is None else residuals
    bottom.set_xlabel(labelled(AXES.get(axis, f"${axis}$"), result.units[axis]))
    bottom.set_xlim(edges[0], edges[-1])


def draw_wake(result: Result, ax: Any) -> None:
    """Velocity against the distance from the rear, with the length of the part that flows back.

    Distances are over the size D of the body, and at the right velocities over the mean one.
    """
    size = result.extra["size"]
    ax.axhline(0, color="black", lw=0.8, ls=":", zorder=1)
    points(ax, result.x["distance"] / size, result.value, result.error, lw=0.8, label=MEASURED)
    found = [c for c in result.comparisons if c.what == "L_r/D"]
    if np.isfinite(result.extra["recirculation"]) and found:
        ends, error = found[0].measured, found[0].error
        ax.axvline(ends, color=COLOURS[1], ls="--", lw=1.3, label="$L_r/D$, from a straight line")
        if np.isfinite(error):
            ax.axvspan(ends - error, ends + error, color=COLOURS[1], alpha=0.25, lw=0)
        if np.isfinite(found[0].expected):
            ax.axvline(found[0].expected, color="black", lw=1.5, label="theory")
    ax.set_xlim(*(result.extra["edges"][[0, -1]] / size))
    ax.set_xlabel(f"distance from the rear of the body over its size $D = {size:.4g}\\,a$")
    ax.set_ylabel(labelled(result.label, result.units["value"]))
    legend_above(ax, columns=2)
    speed = result.extra.get("speed", np.nan)
    if np.isfinite(speed) and speed:
        right = ax.secondary_yaxis("right", functions=(lambda v: v / speed, lambda v: v * speed))
        letter = result.label.split()[-1]
        right.set_ylabel(rf"${letter}/U$,  $U = {speed:.3g}\,a/\tau$: superficial velocity")
        ax.tick_params(right=False)


def _frame(ax: Any, result: Result) -> None:
    """Limit the axis about a constant of theory: noise does not fill the height of the figure.

    All values are within; the error bar of a bin that was nearly empty may go beyond the edge.
    """
    expected, error = result.expected, result.error
    if expected is None or not np.isfinite(expected).any() or np.ptp(expected) > 0:
        return
    level = float(np.nanmean(expected))
    bar = 2 * float(np.nanmedian(error)) if np.isfinite(error).any() else 0.0
    away = abs(result.value[np.isfinite(result.value)] - level)
    half = max(1.5 * (float(away.max(initial=0.0)) + bar), 1e-3 * abs(level))
    if half > 0:
        ax.set_ylim(level - half, level + half)
