"""Results and comparisons as tables: CSV, pandas, xarray."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.io.atomic import write_text
from mesokit.io.optional import package
from mesokit.seam.named import keyed
from mesokit.seam.result import Comparison, Result

if TYPE_CHECKING:
    from numpy.typing import NDArray

EXTRA = "tables"
NUMBERS = ("value", "error", "expected", "fit")


def columns(result: Result) -> dict[str, NDArray[Any]]:
    """A result as columns of equal length: its coordinates, then its numbers.

    >>> r = Result("q", "q", {"y": np.array([1.0, 2.0])}, [3, 4], [0.1, 0.1], "v", {})
    >>> list(columns(r)), columns(r)["value"].tolist()
    (['y', 'value', 'error'], [3.0, 4.0])
    """
    places = np.meshgrid(*result.x.values(), indexing="ij")
    found = {name: place.ravel() for name, place in zip(result.x, places, strict=True)}
    return found | {name: array.ravel() for name, array in _numbers(result).items()}


def dataframe(result: Result) -> Any:
    """A result as a pandas.DataFrame; `attrs` has its units, label and name."""
    made = package("pandas", "data frames", EXTRA).DataFrame(columns(result))
    made.attrs |= _about(result) | {"units": dict(result.units)}
    return made


def dataset(result: Result) -> Any:
    """A result as an xarray.Dataset: value, error, expected and fit over its coordinates."""
    xarray = package("xarray", "labelled arrays", EXTRA)
    unit = {name: {"units": text} for name, text in result.units.items()}
    axes = list(result.x)
    numbers = {
        name: (axes, array, unit.get("value", {})) for name, array in _numbers(result).items()
    }
    places = {name: ([name], axis, unit.get(name, {})) for name, axis in result.x.items()}
    return xarray.Dataset(numbers, places, _about(result))


def write_result(result: Result, path: str | Path) -> Path:
    """A result as a CSV file. Raises RunError."""
    return write_text(path, result_text(result))


def result_text(result: Result) -> str:
    """A result as CSV, whose first line, after `#`, has its units."""
    units = ", ".join(f"{name} in {unit}" for name, unit in result.units.items() if unit)
    about = f"# {result.name}: {result.about}; {units}"
    found = columns(result)
    return f"{about}\n" + _text(list(found), zip(*found.values(), strict=True))


def rows(results: Mapping[str, Result]) -> list[dict[str, Any]]:
    """All comparisons as plain numbers and texts; None where there is no number.

    >>> slip = Comparison("slip", 0.5, 0.1, 0.0, "a/tau")
    >>> row, = rows({"q": Result("q", "q", {}, 1, 0, "v", {}, comparisons=(slip,))})
    >>> row["result"], row["key"], row["measured"], row["deviation"], row["percent"]
    ('q', 'slip', 0.5, 5.0, None)
    """
    return [
        {"result": name, "key": key} | record(comparison)
        for name, result in results.items()
        for key, comparison in keyed(result.comparisons).items()
    ]


def record(comparison: Comparison) -> dict[str, Any]:
    """A comparison as plain numbers and texts."""
    c = comparison
    return {
        "what": c.what,
        "measured": number(c.measured),
        "error": number(c.error),
        "expected": number(c.expected),
        "unit": c.unit,
        "deviation": number(c.deviation),
        "percent": number(c.percent),
        "approximate": c.approximate,
        "steady": c.steady,
        "lower_bound": c.lower_bound,
        "note": c.note,
    }


def number(value: float) -> float | None:
    """A number that JSON knows.

    >>> number(math.nan), number(np.float64(2))
    (None, 2.0)
    """
    return float(value) if math.isfinite(value) else None


def rows_dataframe(results: Mapping[str, Result]) -> Any:
    """All comparisons as a pandas.DataFrame, a row for each."""
    return package("pandas", "data frames", EXTRA).DataFrame(rows(results), columns=HEADINGS)


def write_rows(results: Mapping[str, Result], path: str | Path) -> Path:
    """All comparisons as a CSV file, a row for each. Raises RunError."""
    return write_text(path, rows_text(results))


def rows_text(results: Mapping[str, Result]) -> str:
    """All comparisons as CSV, a row for each."""
    return _text(HEADINGS, (row.values() for row in rows(results)))


HEADINGS = ["result", "key", *record(Comparison("", 0.0, 0.0))]


def _numbers(result: Result) -> dict[str, NDArray[Any]]:
    found = {name: getattr(result, name) for name in NUMBERS}
    return {name: array for name, array in found.items() if array is not None}


def _about(result: Result) -> dict[str, Any]:
    return {
        "name": result.name,
        "label": result.label,
        "theory": result.theory,
        "samples": result.samples,
    }


def _text(headings: list[str], table: Iterable[Iterable[Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(table)
    return text.getvalue()
