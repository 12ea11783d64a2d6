"""Results of observables: numbers with error bars, the theory for them, and comparisons."""

import importlib
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.describe.digits import two_digits
from mesokit.case.describe.shown import Shown
from mesokit.seam.named import find, key_of

Array = NDArray[np.floating[Any]]
FIGURES = "mesokit.report"  # by their names: results know nothing of how they are drawn
TABLES = "mesokit.io.tables"  # and written
EXACT = 2.0**-50  # of a value: an error below is that of rounding
SUSPICIOUS = 4.0  # standard errors
COARSE = 0.2  # of what is expected: a larger error
ROUNDING = 1e-12  # relative: two numbers that differ by less are the same
NOT_STEADY = "not steady"  # how the note of a comparison begins, where that is so
LOWER_BOUND = "error bar is a lower bound"  # what it says somewhere, where that is so


@dataclass(frozen=True)
class Comparison:
    """One measured number next to what theory expects.

    Parameters
    ----------
    what: what was measured, in words, such as "viscosity from curvature".
    measured, error: value and standard error (numbers or 0-d arrays); the error is 0 for what must
        hold exactly. Both are nan where the run does not determine the number, such as a quotient
        whose divisor may be 0.
    expected: the theory, nan where there is none.
    unit: of all three.
    note: what the theory assumes, or what the estimate is. One that starts with "approximate" says
        that the theory is known to be off by more than an error bar: deviations are in percent.
        One that starts with "not steady" says that the run began to measure too early for the
        theory: there is no deviation. One that has "error bar is a lower bound" says so of the
        error: a deviation in such errors is an upper bound.
    inverse: whether the number is one over what was averaged, such as a viscosity from a curvature.
        Its deviation is that of what was averaged, whose error bar is the same on both sides.

    >>> c = Comparison("viscosity", 0.88, 0.01, 0.87, "a^2/time")
    >>> round(c.deviation, 6), round(c.percent, 2)
    (1.0, 1.15)
    >>> print(c)
    viscosity: 0.880(10) a^2/time, expected 0.8700: +1.0 standard errors, +1.1 %
    """

    what: str
    measured: float
    error: float
    expected: float = math.nan
    unit: str = ""
    note: str = ""
    inverse: bool = False

    def __post_init__(self) -> None:
        for name in ("measured", "error", "expected"):
            if isinstance(number := getattr(self, name), np.generic | np.ndarray):
                object.__setattr__(self, name, float(number))

    @property
    def key(self) -> str:
        """Name of the number for scripts and tables.

        >>> Comparison("viscosity from curvature", 0.88, 0.01).key
        'viscosity-from-curvature'
        """
        return key_of(self.what)

    @property
    def deviation(self) -> float:
        """(measured - expected) in standard errors; nan without an error bar or an exact theory.

        >>> round(Comparison("viscosity", 0.317, 0.082, 0.783, inverse=True).deviation, 1)
        -2.3
        """
        if self.approximate or not self.steady or not self.error > EXACT * abs(self.measured):
            return math.nan
        deviation = (self.measured - self.expected) / self.error
        return deviation * self.measured / self.expected if self.inverse else deviation

    @property
    def approximate(self) -> bool:
        """Whether the theory is known to be off by more than an error bar."""
        return self.note.startswith("approximate")

    @property
    def steady(self) -> bool:
        """Whether the run measured the steady state that the theory is of, as far as is known."""
        return not self.note.startswith(NOT_STEADY)

    @property
    def lower_bound(self) -> bool:
        """Whether the error bar may be larger than it is known to be."""
        return LOWER_BOUND in self.note

    @property
    def far(self) -> bool:
        """Whether it is beyond 4 standard errors from an exact theory, as far as is known."""
        return not self.lower_bound and abs(self.deviation) > SUSPICIOUS

    def in_errors(self, unit: str = "standard errors") -> str:
        """The deviation in words, empty where there is none.

        That of a number that is one over what was averaged may be another than its own error bar
        gives: then it is said to be of the inverse.

        >>> Comparison("viscosity", 0.317, 0.082, 0.783, inverse=True).in_errors("s.e.")
        '-2.3 s.e. of 1/value'
        >>> Comparison("slip", 3.0, 1.0, 0.0, note=f"{LOWER_BOUND}: of 2 runs").in_errors("s.e.")
        'at most +3.0 s.e.'
        """
        if not math.isfinite(self.deviation):
            return ""
        shown = signed(self.deviation)
        own = signed((self.measured - self.expected) / self.error)
        of = " of 1/value" if shown != own else ""
        return f"{'at most ' * self.lower_bound}{shown} {unit}{of}"

    @property
    def percent(self) -> float:
        """(measured - expected) in percent of the size of what is expected, nan if that is 0.

        Beside an approximate theory it is nan too where it is noise: within two errors that are
        more than a fifth of what is expected.

        >>> round(Comparison("stress", -1.1, 0.1, -1.0).percent, 6)
        -10.0
        >>> Comparison("a_2", -0.001, 0.014, -0.027, note="approximate: one term").percent
        nan
        """
        difference = self.measured - self.expected
        coarse = self.error > COARSE * abs(self.expected)
        if self.approximate and coarse and abs(difference) < 2 * self.error:
            return math.nan
        if abs(difference) < ROUNDING * abs(self.expected):
            difference = 0.0
        if not self.steady:
            return math.nan
        return 100 * difference / abs(self.expected) if self.expected else math.nan

    def __str__(self) -> str:
        unit = "" if math.isnan(self.measured) else self.unit
        text = f"{self.what}: {with_error(self.measured, self.error)} {unit}".rstrip()
        if not math.isnan(self.expected):
            text += (
                f", expected {self.expected:.4g}"
                if self.expected % 1 == 0
                else (f", expected {self.expected:#.4g}")
            )
        if math.isfinite(self.deviation):
            text += f": {self.in_errors()}"
            if math.isfinite(self.percent) and self.error < abs(self.expected):
                text += f", {in_percent(self.percent)}"
        elif self.approximate and math.isfinite(self.percent):
            text += f": {two_digits(self.percent, sign='+')} %"
        if self.note and (not math.isfinite(self.deviation) or self.lower_bound):
            text += f" ({self.note})"
        return text


def joined(*notes: str) -> str:
    """Notes as one, without those that are empty.

    >>> joined("", "steady flow", "no slip")
    'steady flow; no slip'
    """
    return "; ".join(filter(None, notes))


def with_error(value: float, error: float) -> str:
    """A value with its standard error in the last two digits, as journals print it.

    >>> with_error(0.8705, 0.0123), with_error(1234.5, 12), with_error(2.0, 0.0)
    ('0.871(12)', '1234(12)', '2.000')

    An error far below the value leaves the point where it is.

    >>> with_error(0.6666536, 6.7e-7), with_error(6.7e-7, 1e-8)
    ('0.66665360(67)', '6.70(10)e-07')

    An error that is only that of rounding is none; what has no value is not determined.

    >>> with_error(1.95, 7.6e-19), with_error(math.nan, math.nan)
    ('1.950', 'undetermined')

    A whole number of which no error is known is a count.

    >>> with_error(2.0, math.nan)
    '2'
    """
    if math.isnan(value):
        return "undetermined"
    if error <= EXACT * abs(value):
        error = 0.0
    if math.isnan(error) and value % 1 == 0:
        return f"{value:.0f}"
    if value == 0 and not error > 0:
        return "0"
    if not math.isfinite(value) or not error > 0 or not math.isfinite(error):
        return f"{value:#.4g}"
    digits = 1 - math.floor(math.log10(error))
    if round(error, digits) >= 100 * 10.0**-digits:  # 0.0996 rounds up to three digits
        digits -= 1
    if -3 < digits <= 6:
        shown = f"{round(error * 10.0**digits)}" if digits > 0 else f"{round(error, digits):.0f}"
        return f"{round(value, digits):.{max(digits, 0)}f}({shown})"
    power = math.floor(math.log10(max(abs(value), error)))
    if -3 < power <= 0:  # an error far below the value
        return f"{value:.{digits}f}({error * 10.0**digits:.0f})"
    scaled = with_error(value / 10.0**power, error / 10.0**power)
    return f"{scaled}e{power:+03d}"


def signed(value: float) -> str:
    """A number with its sign and one decimal; zero is +0.0.

    >>> signed(-1.26), signed(-0.04)
    ('-1.3', '+0.0')
    """
    return f"{round(value, 1) + 0.0:+.1f}"


def in_percent(percent: float) -> str:
    """A deviation in percent: one decimal, or two digits of what one decimal would hide.

    >>> in_percent(-12.34), in_percent(0.00731), in_percent(0.0)
    ('-12.3 %', '+0.0073 %', '+0.0 %')
    """
    hidden = 0 < abs(percent) < 0.05
    return f"{two_digits(percent, sign='+') if hidden else signed(percent)} %"


@dataclass(frozen=True, eq=False)
class Result(Shown):
    """Numbers that an observable measured, with error bars and theory.

    Parameters
    ----------
    quantity, name: of the observable.
    drawing: how `mesokit.report` draws it, one of the names in `report/figures.py`; a "curve" of
        any result is its values over the first coordinate.
    x: coordinates of the axes of `value`, in order: numbers, or texts where an axis lists
        components or parts. Empty for a single number.
    value, error, expected: arrays of the shape that `x` gives; the error is one standard error;
        nan where there is none; `expected` is None where there is no theory at all.
    label: what `value` is, for the axis of a plot.
    units: unit of "value" and of each coordinate; a text coordinate may carry its own.
    comparisons: numbers drawn from the data against theory.
    fit: fitted curve, of the shape of `value`.
    theory: what `expected` is, for the legend.
    samples: number of samples behind it.
    extra: other numbers that the plot or a reader may want (plain numbers, texts and arrays).
    """

    quantity: str
    name: str
    x: Mapping[str, NDArray[Any]]
    value: Array
    error: Array
    label: str
    units: Mapping[str, str]
    expected: Array | None = None
    fit: Array | None = None
    theory: str = ""
    comparisons: tuple[Comparison, ...] = ()
    samples: int = 0
    extra: Mapping[str, Any] = field(default_factory=dict)
    drawing: str = "curve"

    def __post_init__(self) -> None:
        shape = tuple(len(axis) for axis in self.x.values())
        for name in ("value", "error", "expected", "fit"):
            array = getattr(self, name)
            if array is None:
                continue
            array = np.asarray(array, float)
            if array.shape != shape:
                raise ValueError(f"{self.name}: {name} has shape {array.shape}, x says {shape}")
            object.__setattr__(self, name, array)

    @property
    def deviation(self) -> Array | None:
        """(value - expected) in standard errors, None without a theory."""
        if self.expected is None:
            return None
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.error > 0, (self.value - self.expected) / self.error, np.nan)

    def __getitem__(self, name: str) -> Comparison:
        """The comparison of that name, or the only one whose name begins with it.

        Raises KeyError, which says what is near.

        >>> r = Result("slope", "slope", {}, 1.0, 0.1, "slope", {},
        ...            comparisons=(Comparison("viscosity from curvature", 0.88, 0.01),))
        >>> r["viscosity"].measured, "slip" in r
        (0.88, False)
        """
        return find(self.comparisons, name)

    def __contains__(self, name: str) -> bool:
        """Whether there is a comparison that `result[name]` finds."""
        try:
            return bool(self[name])
        except KeyError:
            return False

    __iter__ = None  # the numbers are in `value`, the comparisons in `comparisons`

    def select(self, **coordinates: str | float) -> tuple[float, float]:
        """Value and error at given coordinates (the nearest, for numbers).

        Raises KeyError for an unknown coordinate or text.

        >>> r = Result("stress", "stress", {"part": np.array(["kinetic", "total"])},
        ...            np.array([1.0, 3.0]), np.array([0.1, 0.2]), "stress", {"value": "kT/a^3"})
        >>> r.select(part="total")
        (3.0, 0.2)
        """
        index = []
        for name, axis in self.x.items():
            if name not in coordinates:
                raise KeyError(f"{self.name}: give {name}, one of {list(axis)}")
            wanted = coordinates[name]
            if axis.dtype.kind in "US":
                if wanted not in axis:
                    raise KeyError(f"{self.name}: no {name} {wanted!r}; there is {list(axis)}")
                index.append(int(np.flatnonzero(axis == wanted)[0]))
            else:
                index.append(int(np.argmin(abs(axis - float(wanted)))))
        unknown = set(coordinates) - set(self.x)
        if unknown:
            raise KeyError(f"{self.name}: no coordinate {sorted(unknown)}; there is {list(self.x)}")
        return float(self.value[tuple(index)]), float(self.error[tuple(index)])

    def plot(
        self, ax: Any = None, case: Case | None = None, *, label: str = "", colour: str = ""
    ) -> Any:
        """Draw it with error bars, theory and the comparisons; returns the Matplotlib figure.

        Into axes `ax`, which are returned then, the main panel alone is drawn; `label` is its name
        in their legend, `colour` that of its data (another for each result unless said). The
        `case` of the run adds its solids to a map. Raises ValueError for a label or a colour
        without axes.
        """
        if ax is None and (label or colour):
            raise ValueError("label and colour are for several results in the same axes: give ax")
        return importlib.import_module(FIGURES).plot(self, ax, case, label=label, colour=colour)

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame: a row for each value, with its coordinates, error and theory.

        `attrs["units"]` has the units. Raises CaseError without `pip install 'mesokit[tables]'`.
        """
        return importlib.import_module(TABLES).dataframe(self)

    def to_xarray(self) -> Any:
        """An xarray.Dataset: value, error, expected and fit, with their units, over `x`.

        Raises CaseError without `pip install 'mesokit[tables]'`.
        """
        return importlib.import_module(TABLES).dataset(self)

    def to_csv(self, path: str | Path) -> Path:
        """Write a CSV file, a row for each value, and return its path. Raises RunError.

        >>> import tempfile
        >>> r = Result("q", "q", {"y": np.array([0.5])}, [3], [0.1], "speed", {"y": "a"})
        >>> print(r.to_csv(Path(tempfile.mkdtemp()) / "q.csv").read_text())
        # q: speed, 0 samples; y in a
        y,value,error
        0.5,3.0,0.1
        """
        written: Path = importlib.import_module(TABLES).write_result(self, path)
        return written

    def _card(self) -> dict[str, Any]:
        return {"title": self.name, "words": self._words(), "results": [self]}

    @property
    def about(self) -> str:
        """Its label without formulas, and the number of its samples."""
        label = self.label.replace("$", "").replace("\\", "")
        return f"{label}, {self.samples} sample{'s' * (self.samples != 1)}"

    def _words(self) -> str:
        axes = [
            f"{AXIS_WORDS.get(name, name)} ({len(axis)})"
            for name, axis in self.x.items()
            if len(axis) != 1
        ]
        return self.about + f"; by {', '.join(axes)}" * bool(axes)

    def __eq__(self, other: object) -> bool:
        """Every number, text and unit the same (nan equals nan)."""
        if not isinstance(other, Result):
            return NotImplemented
        names = tuple(self.__dataclass_fields__)
        return all(_same(getattr(self, n), getattr(other, n)) for n in names)

    def __repr__(self) -> str:
        lines = [f"{self.name}: {self._words()}"]
        return "\n  ".join(lines + [str(c) for c in self.comparisons])


AXIS_WORDS = {"of": "group", "by": "part", "measured by": "route"}  # where the name is no noun


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, Mapping) and isinstance(b, Mapping):
        return list(a) == list(b) and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(_same(p, q) for p, q in zip(a, b, strict=True))
    if isinstance(a, Comparison) and isinstance(b, Comparison):
        return all(_same(getattr(a, n), getattr(b, n)) for n in a.__dataclass_fields__)
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        a, b = np.asarray(a), np.asarray(b)
        return a.shape == b.shape and bool(
            np.array_equal(a, b, equal_nan=a.dtype.kind == "f" and b.dtype.kind == "f")
        )
    return bool(a == b) or (a != a and b != b)
