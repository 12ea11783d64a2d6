"""Results and comparisons as tables: CSV, pandas, xarray."""

import csv
import io
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.io.atomic import write_text
from mesokit.io.optional import package
from mesokit.seam.named import keyed
from mesokit.seam.result import Comparison, Result

EXTRA = "tables"
NUMBERS = ("value", "error", "expected", "fit")
HEADINGS = [  # of the table of comparisons; all but the first two are fields of a Comparison
    "result", "key", "what", "measured", "error", "expected", "unit", "deviation", "percent",
    "approximate", "steady", "lower_bound", "note",
]  # fmt: skip


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
    unit = {name: {"units": text} for name, text in result.units.items()}
    axes, own = list(result.x), unit.get("value", {})
    numbers = {name: (axes, array, own) for name, array in _numbers(result).items()}
    places = {name: ([name], axis, unit.get(name, {})) for name, axis in result.x.items()}
    xarray = package("xarray", "labelled arrays", EXTRA)
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
    found = {name: getattr(comparison, name) for name in HEADINGS[2:]}
    return {k: v if isinstance(v, str | bool) else number(v) for k, v in found.items()}


def number(value: float) -> float | None:
    """A number for JSON, which has neither nan nor infinity.

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


def _numbers(result: Result) -> dict[str, NDArray[Any]]:
    found = {name: getattr(result, name) for name in NUMBERS}
    return {name: array for name, array in found.items() if array is not None}


def _about(result: Result) -> dict[str, Any]:
    return {name: getattr(result, name) for name in ("name", "label", "theory", "samples")}


def _text(headings: list[str], table: Iterable[Iterable[Any]]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(headings)
    writer.writerows(table)
    return text.getvalue()
