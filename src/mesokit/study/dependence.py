"""A measured number against a parameter: points with error bars, theory, fits."""

import re
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import one_of, show
from mesokit.errors import CaseError
from mesokit.report.caption import below as write_below
from mesokit.report.finish.labels import fit_labels
from mesokit.report.finish.legend import entries, legend_above
from mesokit.report.style import (
    COLOURS,
    LINES,
    MARKERS,
    STYLE,
    WIDTH,
    fonts,
    height_of,
    labelled,
    sparse_logarithm,
)
from mesokit.seam.result import Array, with_error
from mesokit.statistics import Fit, weighted_line

FITS = ("line", "power")
BENT = 0.01  # part of its height by which a straight line may miss a point
EVEN = 0.02  # part by which ratios of neighbours may differ in a geometric sequence
DECADE = 8.0  # largest over smallest value from which the other axis is logarithmic too
WILD = 10.0  # median error bars: one that is longer does not set the axis
MARGIN = 0.05  # of an axis, at either end
NAMED = 3  # points that a legend names
SYMBOL = 0.02  # of the height of a figure, a symbol
ROUGH = "0.4"  # grey of an approximate theory
MARK: dict[str, Any] = {"ls": "none", "marker": "_", "ms": 14, "mew": 1.3}  # theory at a point
SPREAD = r"$\pm$ one standard error"
TICKS = 6  # of values within a decade, each of which has its own


class Theory(NamedTuple):
    """Expectation (n,), nan where it is unknown, at many places (n,) of a curve."""

    x: Array
    expected: Array


class Curve(NamedTuple):
    """Points (n,) of one curve, their expectations (nan where unknown), and its name.

    `theory` names the theory. `between` gives it between the points for an axis that is logarithmic
    or not, or None. `seeds` are rows (m, 3) of place, value and error of the runs that were pooled.
    `cautions` are words before "at" and the points (n,) that they concern. `rough` is true where
    theory is approximate (n,), `steady` where the run measured the steady state of the theory;
    None means nowhere and everywhere.
    """

    label: str
    x: Array
    value: Array
    error: Array
    expected: Array
    theory: str = "theory"
    between: Callable[[bool], Theory | None] | None = None
    seeds: Array = np.empty((0, 3))
    cautions: Sequence[tuple[str, NDArray[np.bool_]]] = ()
    rough: NDArray[np.bool_] | None = None
    steady: NDArray[np.bool_] | None = None

    @property
    def ratios(self) -> tuple[Array, Array]:
        """Measured over expected and its error (n,), nan where it is not known."""
        use = (self.expected != 0) & (self.error < abs(self.expected))
        if self.steady is not None:
            use &= self.steady
        expected = np.where(use, self.expected, np.nan)
        return self.value / expected, self.error / abs(expected)


def draw(
    curves: Sequence[Curve],
    x: tuple[str, str],
    y: tuple[str, str],
    fit: str | None = None,
    log: bool | str | None = None,
    note: str = "",
    width: float | None = None,
) -> Any:
    """A figure of several curves.

    Parameters
    ----------
    x, y: name and unit of each axis.
    fit: "line" or "power", fitted to each curve.
    log: logarithmic axes: "x", "y", "x,y", True for both, False for none. By default x is if its
        values are a geometric sequence, and y if it is then positive and spans a decade; both are
        for a power.
    note: text about the points, for the legend.
    width: width of the figure in inches.

    Raises CaseError for another fit, or one without enough points, and for a logarithmic axis of
    values that are not above zero.
    """
    import matplotlib as mpl

    from mesokit.report.notebook import ShownFigure

    scales = logarithmic(curves, fit, log)
    wide = WIDTH if width is None else width
    with mpl.rc_context(STYLE | fonts(wide)):
        figure = ShownFigure(figsize=(wide, height_of(wide)), layout="constrained")
        below: Any = None
        if _hides_errors(curves):
            ax, below = figure.subplots(2, 1, sharex=True, height_ratios=[3, 1])
        else:
            ax = figure.subplots()
        several = len(curves) > 1  # the legend has their names; all else is written below
        dots = "; dots: each run" * any(len(curve.seeds) for curve in curves)
        notes = [", ".join(filter(None, [note, SPREAD])) + dots] if several else []
        for set_scale, logs in zip((ax.set_xscale, ax.set_yscale), scales, strict=True):
            set_scale("log" if logs else "linear")
        for number, curve in enumerate(curves):
            _draw(ax, curve, number, note, scales, several)
            _say(notes, curve, np.isnan(curve.value), "undetermined at")
            if fit is not None:
                _draw_fit(ax, curve, number, fit)
            for what, some in curve.cautions:
                _caution(notes, curve, what, some)
            if below is not None:
                _draw_ratio(below, curve, number)
        _leave_out_wild(ax, curves, scales[1], notes)
        for axis in (ax.xaxis, ax.yaxis):
            if axis.get_scale() == "log":
                sparse_logarithm(axis, *axis.get_view_interval())
        places = np.unique(np.concatenate([curve.x for curve in curves]))
        if scales[0] and len(places) <= TICKS and places[-1] < 10 * places[0]:
            ax.set_xticks(places, [f"{place:g}" for place in places])
            ax.set_xticks([], minor=True)
        (below or ax).set_xlabel(labelled(*x))
        ax.set_ylabel(labelled(y[0], y[1]))
        if wide < WIDTH:
            legend_above(ax)
        else:
            found = entries([ax])
            ax.legend(found.values(), found, loc="best")
        write_below(figure, "\n".join(notes))
        fit_labels(figure)
        return figure


def logarithmic(
    curves: Sequence[Curve], fit: str | None = None, log: bool | str | None = None
) -> tuple[bool, bool]:
    """True for each axis that is logarithmic, by the rules of `draw`.

    Raises CaseError for other axes, and for a number that is not above zero on such an axis.
    """
    if isinstance(log, str):
        named = [word.strip() for word in log.split(",")]
        if not {*named} <= {"x", "y"}:
            raise CaseError(f"log = {show(log)}: expected x, y or x,y")
        chosen = "x" in named, "y" in named
    elif log is not None:
        chosen = bool(log), bool(log)
    else:
        even = all(geometric(curve.x) for curve in curves)
        chosen = (True, True) if fit == "power" else (even, even and _spans_a_decade(curves))
    for name, logs, each in zip("xy", chosen, ("x", "value"), strict=True):
        values = np.concatenate([getattr(curve, each) for curve in curves])
        values = values[np.isfinite(values)]
        if log is not None and logs and len(values) and values.min() <= 0:
            raise CaseError(
                f"log = {show(name)}: {values.min():g} is among its values; expected all above 0"
            )
    return chosen


def geometric(x: Array) -> bool:
    """True if three or more values (n,) have one ratio from each to the next.

    >>> [geometric(np.array(x)) for x in ([1, 2, 4.0], [1, 2, 3.0], [1, 10.0], [0, 1, 10.0])]
    [True, False, False, False]
    """
    x = np.unique(x)
    if len(x) < 3 or x[0] <= 0:
        return False
    ratios = x[1:] / x[:-1]
    return bool(np.ptp(np.log(ratios)) <= EVEN * np.log(ratios).mean())


def _spans_a_decade(curves: Sequence[Curve]) -> bool:
    """True if measured and expected numbers are positive and span a decade."""
    values = np.concatenate([np.concatenate([c.value, c.expected]) for c in curves])
    values = values[np.isfinite(values)]
    return bool(len(values) and values.min() > 0 and values.max() >= DECADE * values.min())


def _draw(
    ax: Any, curve: Curve, number: int, note: str, scales: tuple[bool, bool], several: bool
) -> None:
    colour, marker = COLOURS[number % len(COLOURS)], MARKERS[number % len(MARKERS)]
    look = {"mfc": "white", "color": colour, "ms": 5, "capsize": 2, "zorder": 3}
    label = curve.label if several else ", ".join(filter(None, [curve.label, note, SPREAD]))
    ax.errorbar(curve.x, curve.value, curve.error, fmt=marker, label=label, **look)
    if len(curve.seeds):
        dots = {"ms": 2.5, "alpha": 0.55, "color": colour, "zorder": 2.5}
        label = "" if several else ", ".join(filter(None, [curve.label, "each run"]))
        ax.plot(*curve.seeds[:, :2].T, "o", label=label, **dots)
    if np.isfinite(curve.expected).any():
        _draw_theory(ax, curve, LINES[number % len(LINES)], scales, several)


def _draw_theory(
    ax: Any, curve: Curve, dash: Any, scales: tuple[bool, bool], several: bool
) -> None:
    """A line where theory holds, and a grey dashed one where it is approximate."""
    known = np.isfinite(curve.expected)
    x, expected, marks, where = curve.x, curve.expected, dict[str, Any](), ""
    if not _straight(x[known], expected[known], scales):
        between = curve.between(scales[0]) if curve.between else None
        if between is not None:
            x, expected = between
        else:  # no theory is known for what would join the points
            marks, where = MARK, ", at the points"
    of = f", {curve.label}" * bool(curve.label and not several)
    holds, rough = _parts(curve, x, expected, joined=not marks)
    black: dict[str, Any] = {"ls": dash, "color": "black"}
    grey: dict[str, Any] = {"ls": "--", "color": ROUGH}
    parts = (holds, curve.theory, black), (rough, "theory, approximate", grey)
    for part, words, look in parts:
        if np.isfinite(part).any():
            look = {"lw": 1.3, "zorder": 2, **look, **marks}
            ax.plot(x, part, label=f"{words}{of}{where}", **look)
    known = np.isfinite(expected)
    alone = known & ~np.append(known[1:], False) & ~np.append(False, known[:-1])
    ax.plot(x[alone], expected[alone], color="black", zorder=2, **MARK)


def _parts(curve: Curve, x: Array, expected: Array, joined: bool) -> tuple[Array, Array]:
    """Expectations at places (m,) where theory holds, and where it is approximate; nan elsewhere.

    Between two points theory holds if it does at both; a line that is `joined` begins at a point
    where theory holds.
    """
    rough = np.zeros(len(curve.x), bool) if curve.rough is None else curve.rough
    low = np.maximum(np.searchsorted(curve.x, x, "right") - 1, 0)  # the point at or below a place
    high = np.minimum(np.searchsorted(curve.x, x, "left"), len(rough) - 1)
    holds = ~rough[low] & ~rough[high]
    at = joined & (low == high)
    near = rough[np.maximum(low - 1, 0)] | rough[np.minimum(high + 1, len(rough) - 1)]
    return np.where(holds, expected, np.nan), np.where(~holds | (at & near), expected, np.nan)


def _hides_errors(curves: Sequence[Curve]) -> bool:
    """True if most error bars of points with theory are smaller than the symbols."""
    ratios = np.concatenate([curve.ratios[0] for curve in curves])
    error = np.concatenate([curve.error for curve in curves])[np.isfinite(ratios)]
    value = np.concatenate([curve.value for curve in curves])
    value = value[np.isfinite(value)]
    return bool(len(error) > 1 and np.median(error) < SYMBOL * np.ptp(value))


def _draw_ratio(ax: Any, curve: Curve, number: int) -> None:
    look: Any = {"mfc": "white", "color": COLOURS[number % len(COLOURS)], "ms": 4, "capsize": 2}
    ax.axhline(1, color="black", lw=1, zorder=1)
    ax.errorbar(curve.x, *curve.ratios, fmt=MARKERS[number % len(MARKERS)], **look)
    ax.set_ylabel("measured\n/ theory")


def _draw_fit(ax: Any, curve: Curve, number: int, fit: str) -> None:
    found, colour = fitted(curve, fit), COLOURS[number % len(COLOURS)]
    space = np.geomspace if fit == "power" else np.linspace
    at = space(curve.x.min(), curve.x.max(), 200)
    ax.plot(at, found(at), "--", color=colour, lw=1.1, label=found.legend, zorder=1)


def _leave_out_wild(ax: Any, curves: Sequence[Curve], logs: bool, notes: list[str]) -> None:
    """Limit the axis to the other points if a few error bars are longer than all of them."""
    rows = [np.stack([c.x, c.value, c.error], axis=1) for c in curves]
    value, error = np.concatenate([*rows, *(c.seeds for c in curves)])[:, 1:].T
    finite = np.isfinite(value) & np.isfinite(error)
    if not finite.any():
        return
    most = WILD * float(np.median(error[finite]))
    calm = np.isfinite(value) & ~(error > most)
    bars = np.nan_to_num(np.where(calm, error, 0.0))
    ends = [(value - bars)[calm], (value + bars)[calm], *(c.expected for c in curves)]
    shown = np.concatenate(ends)
    shown = shown[np.isfinite(shown) & ((shown > 0) | (not logs))]
    if not len(shown) or not (error[finite & ~calm] > np.ptp(shown)).any():
        return
    low, high = (np.log(shown) if logs else shown)[[shown.argmin(), shown.argmax()]]
    margin = MARGIN * (high - low)
    limits = np.array([low - margin, high + margin])
    ax.set_ylim(*(np.exp(limits) if logs else limits))
    for curve in curves:
        _say(notes, curve, curve.error > most, "error bar beyond the axis:")


def _say(notes: list[str], curve: Curve, some: Any, what: str) -> None:
    """Name points with their values in a note below the figure."""
    if not some.any():
        return
    points = zip(curve.x[some], curve.value[some], curve.error[some], strict=True)
    words = [
        f"{x:g}" if np.isnan(value) else f"{with_error(value, error)} at {x:g}"
        for x, value, error in points
    ]
    notes.append(f"{_of(curve)}{what} {_first_and_more(words)}")


def _caution(notes: list[str], curve: Curve, what: str, some: NDArray[np.bool_]) -> None:
    """Name points with a caution in a note below the figure."""
    if not some.any():
        return
    words = _first_and_more([f"{x:g}" for x in curve.x[some]])
    where = "all points" if some.all() and len(some) > 1 else words
    notes.append(f"{_of(curve)}{what} at {where}")


def _first_and_more(words: Sequence[str]) -> str:
    more = [f"{len(words) - NAMED} more"] * (len(words) > NAMED)
    return ", ".join([*words[:NAMED], *more])


def _of(curve: Curve) -> str:
    return f"{curve.label}, " * bool(curve.label)


class Fitted(NamedTuple):
    """A fit to one curve: `fit` of y, or of the logarithms for a power, and its text.

    `formula` is y = ..., `label` the name of the curve.
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
    power = kind == "power"
    data = (np.log(x), np.log(value), error / value) if power else (x, value, error)
    found = weighted_line(*data)
    (start, slope), (error_start, error_slope) = found.coefficients.tolist(), found.errors.tolist()
    if power:
        front = float(np.exp(start))
        words = f"{with_error(front, front * error_start)} x^{with_error(slope, error_slope)}"
    else:
        sign = "-" if slope < 0 else "+"
        words = f"{with_error(start, error_start)} {sign} {with_error(abs(slope), error_slope)} x"
    return Fitted(curve.label, kind, found, f"y = {words}")


def _straight(x: Array, y: Array, scales: tuple[bool, bool]) -> bool:
    """True if two or more points (n,) of a curve lie on a line in these axes."""
    if len(x) < 2:
        return False
    if np.ptp(y) <= BENT * abs(y).max():
        return True
    if any(logs and (z <= 0).any() for logs, z in zip(scales, (x, y), strict=True)):
        return False
    u, v = (np.log(z) if logs else z for logs, z in zip(scales, (x, y), strict=True))
    on_it = np.interp(u, [u[0], u[-1]], [v[0], v[-1]])
    return len(x) > 2 and bool(abs(v - on_it).max() <= BENT * np.ptp(v))
