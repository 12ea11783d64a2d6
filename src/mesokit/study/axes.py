"""Axes of a study: lists, ranges, and keys that change together."""

from __future__ import annotations

import contextlib
import itertools
import json
import math
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mesokit.case.component import show
from mesokit.errors import CaseError

RANGE = re.compile(r"\s*([^:,\s]+):([^:,\s]+):(\d+)(:log)?\s*")
FORM = "expected KEY=VALUE,VALUE,... or KEY=FIRST:LAST:NUMBER, such as fluid.timestep=0.05:0.2:4"
MOST = 100_000  # runs of a study


@dataclass(frozen=True)
class Axis:
    """Keys of a case that change together, and the values that they take.

    Parameters
    ----------
    keys: key paths, such as ("fluid.timestep", "run.steps").
    values: one row for each point of the axis, with a value for each key.

    Raises CaseError without keys or values, or for a row of another length.

    >>> axis = Axis.parse("fluid.timestep=0.1,0.05; run.steps=1000,2000")
    >>> [point for point in axis]
    [{'fluid.timestep': 0.1, 'run.steps': 1000}, {'fluid.timestep': 0.05, 'run.steps': 2000}]
    >>> [point["fluid.kT"] for point in Axis.parse("fluid.kT=1:100:3:log")]
    [1.0, 10.0, 100.0]
    """

    keys: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]

    def __post_init__(self) -> None:
        if not self.keys or not self.values:
            raise CaseError(f"vary {', '.join(self.keys)}: no value; {FORM}")
        for row in self.values:
            if len(row) != len(self.keys):
                raise CaseError(f"vary {', '.join(self.keys)}: {show(row)}: expected a value each")

    def __iter__(self) -> Iterator[dict[str, Any]]:
        for row in self.values:
            yield dict(zip(self.keys, row, strict=True))

    @classmethod
    def parse(cls, text: str) -> Axis:
        """From 'KEY=VALUES; KEY=VALUES', as the command line has it. Raises CaseError."""
        columns: dict[str, list[Any]] = {}
        for part in text.split(";"):
            key, equals, values = part.partition("=")
            if not equals or not key.strip() or not values.strip():
                raise CaseError(f"vary {show(text)}: {FORM}")
            columns[key.strip()] = _values(key.strip(), values)
        return cls._of(columns)

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Axis:
        """From the keys of a [[vary]] table: lists, or ranges as texts. Raises CaseError."""
        if not isinstance(table, Mapping):
            raise CaseError(f"vary = {show(table)}: expected [[vary]], in double brackets")
        columns = {}
        for key, given in _flat(table):
            if isinstance(given, str):
                given = _values(key, given)
            if not isinstance(given, Sequence) or not given:
                why = "expected a list, or a range as a text"
                raise CaseError(f"vary.{key} = {show(given)}: {why}")
            columns[key] = list(given)
        return cls._of(columns)

    @classmethod
    def from_mapping(cls, vary: Mapping[Any, Any]) -> list[Axis]:
        """The axes of a dictionary: by key the values, by several keys rows of values.

        >>> [axis.keys for axis in Axis.from_mapping({"fluid.kT": [1, 2], ("a", "b"): [(1, 2)]})]
        [('fluid.kT',), ('a', 'b')]
        """
        axes = []
        for key, given in vary.items():
            given = _values(key, given) if isinstance(given, str) else given
            if isinstance(given, np.ndarray):
                given = given.tolist()
            if not isinstance(given, Sequence):
                raise CaseError(f"vary {show(key)} = {show(given)}: expected a list of values")
            linked = isinstance(key, tuple)
            rows = [tuple(row) if linked else (row,) for row in given]
            axes.append(cls(key if linked else (str(key),), tuple(rows)))
        return axes

    def table(self) -> dict[str, list[Any]]:
        """Values by key, as in a [[vary]] table."""
        return {key: [row[i] for row in self.values] for i, key in enumerate(self.keys)}

    def text(self) -> str:
        """The text of the option --vary.

        >>> Axis(("fluid.kT", "run.steps"), ((1.0, 10), (2.0, 20))).text()
        'fluid.kT=1.0,2.0; run.steps=10,20'
        """
        columns = self.table().items()
        return "; ".join(f"{key}={','.join(map(json.dumps, values))}" for key, values in columns)

    @classmethod
    def _of(cls, columns: dict[str, list[Any]]) -> Axis:
        lengths = {key: len(values) for key, values in columns.items()}
        if len(set(lengths.values())) > 1:
            words = ", ".join(f"{key} has {n}" for key, n in lengths.items())
            raise CaseError(f"vary: keys that change together need as many values: {words}")
        return cls(tuple(columns), tuple(zip(*columns.values(), strict=True)))


def grid(axes: Sequence[Axis]) -> list[dict[str, Any]]:
    """Every combination of the points of all axes. Raises CaseError for a key of two axes.

    >>> len(grid([Axis.parse("a=1,2"), Axis.parse("b=1,2,3")]))
    6
    """
    keys = [key for axis in axes for key in axis.keys]
    for key in keys:
        if key == "run.seed":
            raise CaseError("vary run.seed: expected seeds of the study (--seeds), not a key")
        if keys.count(key) > 1:
            raise CaseError(f"vary {key}: given twice")
    points = itertools.product(*axes)
    return [{key: value for part in point for key, value in part.items()} for point in points]


def _values(key: str, text: str) -> list[Any]:
    where = f"vary {key}={text.strip()}"
    if found := RANGE.fullmatch(text):
        try:
            first, last, number = float(found[1]), float(found[2]), int(found[3])
        except ValueError:
            raise CaseError(f"{where}: {FORM}") from None
        if not (math.isfinite(first) and math.isfinite(last)):
            raise CaseError(f"{where}: expected two finite numbers")
        if not math.isfinite(last - first):
            raise CaseError(f"{where}: expected two numbers, not that far apart")
        if number > MOST:
            raise CaseError(f"{where}: expected at most {MOST} values")
        if found[4] and not (first > 0 and last > 0):
            raise CaseError(f"{where}: a logarithmic range begins above 0")
        space = np.geomspace if found[4] else np.linspace
        values = [float(f"{value:.12g}") for value in space(first, last, number)]
        whole = all(re.fullmatch(r"[-+]?\d+", end) for end in found.group(1, 2)) and not found[4]
        whole = whole and all(value == round(value) for value in values)
        return [int(value) for value in values] if whole else list(values)
    with contextlib.suppress(tomllib.TOMLDecodeError):
        return list(tomllib.loads(f"values = [{text}]")["values"])
    if re.fullmatch(r"\s*[-+.\deE]+:[-+.\deE:]*\s*", text):
        raise CaseError(f"{where}: {FORM}")
    return [_value(part.strip()) for part in text.split(",")]  # bare words are texts


def _value(text: str) -> Any:
    with contextlib.suppress(tomllib.TOMLDecodeError):
        return tomllib.loads(f"value = {text}")["value"]
    return text


def _flat(table: Mapping[str, Any], start: str = "") -> Iterator[tuple[str, Any]]:
    """Key paths of a table, whether written with dots or as tables."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{start}{key}.")
        else:
            yield f"{start}{key}", value
