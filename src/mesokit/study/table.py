"""Table of a study: every compared number at every point, from the samples of all seeds."""

import csv
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.io.atomic import replacing
from mesokit.io.optional import package
from mesokit.seam.result import Comparison
from mesokit.statistics import ChiSquare, chi_square
from mesokit.study.plan import Planned, by_point, pooled_numbers, short_names

NUMBERS = [  # of a Comparison, in the order of the table
    "measured", "error", "expected", "deviation", "percent", "approximate", "steady",
    "lower_bound", "unit",
]  # fmt: skip


@dataclass(frozen=True)
class Pooled:
    """One compared number at one point of a study.

    Parameters
    ----------
    point: the values that are varied, by key path.
    observable, key: which number, such as "velocity-profile" and "viscosity-from-curvature".
    number: from the samples of all seeds, as `mesokit.merge` pools them, and what is expected.
    each: the same number of each seed alone.
    runs: how many seeds are pooled.
    scatter: the standard error of the mean that follows from how the seeds scatter, nan for one.
    seeds: chi-square of the seeds against their mean, by their own error bars; None where these
        are not all known or there is one seed only. A small p says that error bars are too small,
        p near 1 that they are too large.
    """

    point: Mapping[str, Any]
    observable: str
    key: str
    number: Comparison
    each: tuple[Comparison, ...]
    runs: int
    scatter: float
    seeds: ChiSquare | None

    @property
    def name(self) -> str:
        """Observable and key, as `files.comparisons()` has them."""
        return f"{self.observable}.{self.key}"

    def row(self) -> dict[str, Any]:
        """As a row of a table."""
        return {
            **self.point,
            "result": self.observable,
            "key": self.key,
            **{name: getattr(self.number, name) for name in NUMBERS},
            "runs": self.runs,
            "scatter": self.scatter,
            "chi2": self.seeds.chi2 if self.seeds else math.nan,
            "p": self.seeds.p if self.seeds else math.nan,
            "note": self.number.note,
        }


def table(runs: Iterable[Planned]) -> list[Pooled]:
    """Every compared number at every point, from the runs that have ended."""
    groups = by_point([run for run in runs if run.ended])
    return [row for group in groups for row in _of_point(group)]


def _of_point(runs: Sequence[Planned]) -> Iterator[Pooled]:
    each: dict[tuple[str, str], list[Comparison]] = {}
    for run in runs:
        for name, key, comparison in run.numbers.compared:
            each.setdefault((name, key), []).append(comparison)
    lengths = [float(run.numbers.steps) for run in runs]
    for name, key, number in pooled_numbers(runs):
        seeds = each.get((name, key), [])
        weights = lengths if len(seeds) == len(runs) else [1.0] * len(seeds)
        yield Pooled(
            runs[0].point, name, key, number, tuple(seeds), len(runs), *scattered(seeds, weights)
        )


def scattered(
    each: Sequence[Comparison], weights: Sequence[float]
) -> tuple[float, ChiSquare | None]:
    """Scatter of one number over several runs: standard error of its mean, and chi-square.

    Weights of the mean are the lengths of the runs. Error bars of runs are estimates that are low
    where the value is, and would bias the mean. Chi-square is about the mean that is weighted by
    them, which makes it least.

    >>> runs = [Comparison("slip", 1.0, 0.3, 0.9), Comparison("slip", 2.0, 0.4, 0.9)]
    >>> spread, seeds = scattered(runs, [100, 100])
    >>> spread, round(seeds.chi2, 3)
    (0.5, 4.0)
    """
    n = len(each)
    if n < 2:
        return math.nan, None
    share = np.array(weights) / np.sum(weights)
    values, errors = (np.array([getattr(c, name) for c in each]) for name in ("measured", "error"))
    mean = float(share @ values)
    spread = float(np.sqrt(share**2 @ (values - mean) ** 2 * n / (n - 1)))
    if not (np.isfinite(values).all() and np.isfinite(errors).all() and errors.min() > 0):
        return spread, None
    nearest = np.average(values, weights=errors**-2.0)
    return spread, chi_square(values, np.full(n, nearest), errors, fitted=1)


def lines(rows: Iterable[Pooled], keys: Sequence[str]) -> list[str]:
    """The rows in words, point after point; `keys` are varied."""
    names = dict(zip(keys, short_names(keys), strict=True))
    found, last = [], None
    for row in rows:
        if row.point != last:
            point = [f"{names[key]} = {value}" for key, value in row.point.items()]
            runs = f"{row.runs} runs" if row.runs > 1 else "1 run"
            found.append(f"{', '.join(point) or 'all'} ({runs})")
            last = row.point
        line = f"  {row.observable}: {row.number}"
        if row.seeds is not None:
            chi2, dof, p = row.seeds.chi2, row.seeds.dof, row.seeds.p
            line += f"; seeds: chi-square {chi2:.2g} of {dof}, p = {p:.2g}"
        found.append(line)
    return found


def dataframe(rows: Sequence[Pooled]) -> Any:
    """As a pandas.DataFrame, a row for each number at each point."""
    return package("pandas", "data frames", "tables").DataFrame([row.row() for row in rows])


def write(rows: Sequence[Pooled], path: str | Path) -> Path:
    """As a CSV file, where a number that is not determined has an empty field. Raises RunError."""
    names = list(dict.fromkeys(name for row in rows for name in row.row()))
    with replacing(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        for row in rows:  # nan is the only value that differs from itself
            writer.writerow({k: v if v == v else "" for k, v in row.row().items()})
    return Path(path)
