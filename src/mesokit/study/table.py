"""What the runs of a study say together: every compared number, pooled over the seeds."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mesokit.io.atomic import replacing
from mesokit.io.optional import package
from mesokit.observe.shared.result import Comparison
from mesokit.statistics import ChiSquare, chi_square
from mesokit.study.plan import Planned, by_point


@dataclass(frozen=True)
class Pooled:
    """One compared number at one point of a study.

    Parameters
    ----------
    point: the values that are varied, by key path.
    observable, key: which number, such as "velocity-profile" and "viscosity-from-curvature".
    number: its mean over the seeds with the standard error that follows from the runs' own error
        bars, and what is expected.
    runs: how many seeds it is the mean of.
    scatter: the standard error of the mean that follows from how the seeds scatter, nan for one.
    seeds: chi-square of the seeds against their mean, by their own error bars; None where these
        are not all known or there is one seed only. A small p says that error bars are too small,
        p near 1 that they are too large.
    """

    point: Mapping[str, Any]
    observable: str
    key: str
    number: Comparison
    runs: int
    scatter: float
    seeds: ChiSquare | None

    @property
    def name(self) -> str:
        """Observable and key, as `files.comparisons()` has them."""
        return f"{self.observable}.{self.key}"

    def row(self) -> dict[str, Any]:
        """As a row of a table."""
        number, seeds = self.number, self.seeds
        return {
            **self.point,
            "result": self.observable,
            "key": self.key,
            "measured": number.measured,
            "error": number.error,
            "expected": number.expected,
            "deviation": number.deviation,
            "percent": number.percent,
            "unit": number.unit,
            "runs": self.runs,
            "scatter": self.scatter,
            "chi2": seeds.chi2 if seeds else math.nan,
            "p": seeds.p if seeds else math.nan,
            "note": number.note,
        }


def table(runs: Iterable[Planned]) -> list[Pooled]:
    """Every compared number at every point, from the runs that have ended."""
    found: list[Pooled] = []
    for group in by_point([run for run in runs if run.ended]):
        found += _of_point(group)
    return found


def _of_point(runs: Sequence[Planned]) -> Iterator[Pooled]:
    numbers: dict[tuple[str, str], list[tuple[Comparison, float]]] = {}
    for run in runs:
        steps, compared = run.numbers
        for name, key, comparison in compared:
            numbers.setdefault((name, key), []).append((comparison, steps))
    for (name, key), each in numbers.items():
        number, scatter, seeds = pooled([c for c, _ in each], [float(s) for _, s in each])
        yield Pooled(runs[0].point, name, key, number, len(each), scatter, seeds)


def pooled(
    each: Sequence[Comparison], weights: Sequence[float]
) -> tuple[Comparison, float, ChiSquare | None]:
    """One number of several runs: their mean, its error by scatter, chi-square about it.

    Weights are the lengths of the runs, not their own error bars: these are estimates, too, which
    run low where the value does, and would pull the mean.

    >>> runs = [Comparison("slip", 1.0, 0.3, 0.9), Comparison("slip", 2.0, 0.4, 0.9)]
    >>> number, scatter, seeds = pooled(runs, [100, 100])
    >>> print(number), scatter, round(seeds.chi2, 3)
    slip: 1.50(25), expected 0.9000: +2.4 standard errors, +66.7 %
    (None, 0.5, 4.34)
    """
    share = np.array(weights) / np.sum(weights)
    values, errors = (np.array([getattr(c, n) for c in each]) for n in ("measured", "error"))
    mean = float(share @ values)
    error = float(np.sqrt(share**2 @ errors**2))
    n = len(each)
    spread = float(np.sqrt(share**2 @ (values - mean) ** 2 * n / (n - 1))) if n > 1 else math.nan
    known = n > 1 and np.isfinite(values).all() and np.isfinite(errors).all() and errors.min() > 0
    seeds = chi_square(values, np.full(n, mean), errors, fitted=1) if known else None
    first = each[0]
    expected = float(share @ np.array([c.expected for c in each]))
    notes = [c.note for c in each]
    early = next((c.note for c in each if not c.steady), "")
    note = first.note if len({*notes}) == 1 or first.approximate else _shared(notes)
    note = early or note
    return Comparison(first.what, mean, error, expected, first.unit, note), spread, seeds


def _shared(notes: Sequence[str]) -> str:
    """What the notes of several runs say alike, up to the numbers in them."""
    each = [note.split("; ") for note in notes]
    alike = [part for part in each[0] if part and all(part in parts for parts in each)]
    if any("lower bound" in note for note in notes):
        alike.append("error bar is a lower bound")
    return "; ".join(dict.fromkeys(alike))


def dataframe(rows: Sequence[Pooled]) -> Any:
    """As a pandas.DataFrame, a row for each number at each point."""
    return package("pandas", "data frames", "tables").DataFrame([row.row() for row in rows])


def write(rows: Sequence[Pooled], path: str | Path) -> Path:
    """As a CSV file. Raises RunError."""
    names = list(dict.fromkeys(name for row in rows for name in row.row()))
    with (
        replacing(path) as temporary,
        temporary.open("w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.DictWriter(file, names)
        writer.writeheader()
        writer.writerows(row.row() for row in rows)
    return Path(path)
