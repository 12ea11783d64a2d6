"""A measured number against a parameter: points with error bars, theory, fits."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mesokit.case.component import one_of, show
from mesokit.errors import CaseError
from mesokit.observe.shared.result import Array, with_error
from mesokit.report.style import (
    COLOURS,
    HEIGHT,
    LINES,
    MARKERS,
    STYLE,
    WIDTH,
    labelled,
    sparse_logarithm,
)
from mesokit.statistics import Fit, weighted_line

FITS = ("line", "power")
BENT = 0.01  # part of its height by which a straight line may miss a point
DECADE = 8.0  # last over first value beyond which an axis is logarithmic


class Curve(NamedTuple):
    """Points (n,) of one curve, what is expected there (nan where nothing is), and its name.

    `theory` is what the expectation is, in a few words.
    """

    label: str
    x: Array
    value: Array
    error: Array
    expected: Array
    theory: str = "theory"


def draw(
    curves: Sequence[Curve],
    x: tuple[str, str],
    y: tuple[str, str],
    fit: str | None = None,
    log: bool | None = None,
    note: str = "",
) -> Any:
    """A figure of several curves.

    Parameters
    ----------
    curves: what is drawn.
    x, y: name and unit of each axis.
    fit: "line" or "power", fitted to each curve.
    log: whether axes are logarithmic; where values span a decade or a power is fitted unless said.
    note: what the points are, for the legend.

    Raises CaseError for another fit, or one without enough points.
    """
    import matplotlib as mpl

    from mesokit.report.notebook import ShownFigure

    with mpl.rc_context(STYLE):
        figure = ShownFigure(figsize=(WIDTH, HEIGHT), layout="constrained")
        ax = figure.subplots()
        wide = all(_spans(curve.x) for curve in curves)
        if log or (log is None and (wide or fit == "power")):
            ax.set_xscale("log")
        if log or (log is None and fit == "power"):
            ax.set_yscale("log")
        for number, curve in enumerate(curves):
            _draw(ax, curve, number, note, fit)
        for axis in (ax.xaxis, ax.yaxis):
            if axis.get_scale() == "log":
                sparse_logarithm(axis, *axis.get_view_interval())
        ax.set_xlabel(labelled(*x))
        ax.set_ylabel(labelled(y[0], y[1]))
        ax.legend(loc="best")
        return figure


def _draw(ax: Any, curve: Curve, number: int, note: str, fit: str | None) -> None:
    colour = COLOURS[number % len(COLOURS)]
    words = ", ".join(filter(None, [curve.label, note]))
    look = {"mfc": "white", "color": colour, "ms": 5, "capsize": 2, "zorder": 3}
    label = f"{words}, $\\pm$ one standard error"
    marker = MARKERS[number % len(MARKERS)]
    ax.errorbar(curve.x, curve.value, curve.error, fmt=marker, label=label, **look)
    known = np.isfinite(curve.expected)
    if known.any():
        label = f"{curve.theory}, {curve.label}" if curve.label else curve.theory
        look = {"ls": LINES[number % len(LINES)], "color": "black", "lw": 1.3, "zorder": 2}
        x, expected = curve.x[known], curve.expected[known]
        if not _straight(ax, x, expected):  # between the points nobody has asked theory
            look |= {"ls": "", "marker": "_", "ms": 14, "mew": 1.3}
        ax.plot(x, expected, label=label, **look)
    if fit is not None:
        found = fitted(curve, fit)
        space = np.geomspace if fit == "power" else np.linspace
        at = space(curve.x.min(), curve.x.max(), 200)
        ax.plot(at, found(at), "--", color=colour, lw=1.1, label=found.legend, zorder=1)


class Fitted(NamedTuple):
    """A fit to one curve: `fit` of y, or of the logarithms for a power, and what it says.

    `formula` is y = ... in words, `label` of which curve.
    """

    label: str
    kind: str
    fit: Fit
    formula: str

    def __call__(self, x: Array) -> Array:
        """The fitted curve at `x`."""
        return np.asarray(np.exp(self.fit(np.log(x))) if self.kind == "power" else self.fit(x))

    def __str__(self) -> str:
        p = "" if np.isnan(self.fit.p) else f", p = {self.fit.p:.2g}"
        return f"{self.label and f'{self.label}: '}{self.formula}{p}"

    @property
    def legend(self) -> str:
        """The same for a picture."""
        formula = re.sub(r"\^(\S+)", r"^{\1}", self.formula).replace(" x", r"\,x")
        p = "" if np.isnan(self.fit.p) else f", $p$ = {self.fit.p:.2g}"
        return f"fit: ${formula}${p}"


def fitted(curve: Curve, kind: str) -> Fitted:
    """A straight line y = a + b x, or a power y = a x^b, through the points that have error bars.

    Raises CaseError for another kind, or too few such points (above 0, for a power).

    >>> x = np.array([1.0, 2.0, 4.0])
    >>> print(fitted(Curve("", x, 3 * x**2, 0.01 * x**2, x), "power"))
    y = 3.0000(91) x^2.0000(34), p = 1
    """
    if kind not in FITS:
        raise CaseError(f"fit = {show(kind)}: expected {one_of(FITS)}")
    use = np.isfinite(curve.value) & (curve.error > 0)
    if kind == "power":
        use &= (curve.value > 0) & (curve.x > 0)
    x, value, error = curve.x[use], curve.value[use], curve.error[use]
    if len(np.unique(x)) < 2:
        raise CaseError(f"fit = {show(kind)}: too few points with an error bar")
    if kind == "power":
        found = weighted_line(np.log(x), np.log(value), error / value)
        front = float(np.exp(found.coefficients[0]))
        first = with_error(front, front * float(found.errors[0]))
        second = with_error(float(found.coefficients[1]), float(found.errors[1]))
        return Fitted(curve.label, kind, found, f"y = {first} x^{second}")
    found = weighted_line(x, value, error)
    start, slope = (float(c) for c in found.coefficients)
    first = with_error(start, float(found.errors[0]))
    second = with_error(abs(slope), float(found.errors[1]))
    sign = "-" if slope < 0 else "+"
    return Fitted(curve.label, kind, found, f"y = {first} {sign} {second} x")


def _straight(ax: Any, x: Array, y: Array) -> bool:
    """Whether points (n,) of a curve lie on a line in these axes; one alone does not."""
    if len(x) < 2:
        return False
    if np.ptp(y) <= BENT * abs(y).max():
        return True
    scales = ax.get_xscale(), ax.get_yscale()
    if any(s == "log" and (z <= 0).any() for s, z in zip(scales, (x, y), strict=True)):
        return False
    u, v = (np.log(z) if s == "log" else z for s, z in zip(scales, (x, y), strict=True))
    on_it = np.interp(u, [u[0], u[-1]], [v[0], v[-1]])
    return len(x) > 2 and bool(abs(v - on_it).max() <= BENT * np.ptp(v))


def _spans(x: Array) -> bool:
    return len(x) > 1 and bool(x.min() > 0) and bool(x.max() / x.min() >= DECADE)
