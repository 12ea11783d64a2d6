"""The table of a study on pages: number after number, with a line for each point."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from mesokit.report.table import cells
from mesokit.study.plan import short_names
from mesokit.study.table import Pooled

DOUBTFUL = 1e-4  # p of chi-square: as rare by chance as a deviation of 4 standard errors


class Line(NamedTuple):
    """One number at one point; `far` if theory is many errors away, `doubtful` if the seeds are."""

    point: list[str]
    measured: str
    expected: str
    deviation: str
    seeds: str
    runs: int
    note: str
    far: bool
    doubtful: bool


class Group(NamedTuple):
    """One number at all points: its name, unit, and a note that holds at all of them."""

    result: str
    what: str
    unit: str
    note: str
    lines: list[Line]


class Numbers(NamedTuple):
    """Varied keys as headings, and all numbers; `seeds` and `notes` if any line has them."""

    keys: list[str]
    groups: list[Group]
    seeds: bool
    notes: bool


def numbers(rows: Sequence[Pooled], keys: Sequence[str]) -> Numbers:
    """The rows of a table by their numbers."""
    found: dict[str, list[Pooled]] = {}
    for row in rows:
        found.setdefault(row.name, []).append(row)
    groups = []
    for of_number in found.values():
        first = of_number[0].number
        shared = first.note if len({row.number.note for row in of_number}) == 1 else ""
        lines = [_line(row, shared) for row in of_number]
        groups.append(Group(of_number[0].observable, first.what, first.unit, shared, lines))
    every = [line for group in groups for line in group.lines]
    seeds, notes = any(line.seeds for line in every), any(line.note for line in every)
    return Numbers(short_names(keys), groups, seeds, notes)


def _line(row: Pooled, shared: str) -> Line:
    _, measured, expected, _, deviation, note = cells(row.number)
    seeds, doubtful = "", False
    if row.seeds is not None:
        seeds = f"{row.seeds.chi2:.2g} of {row.seeds.dof}, p {row.seeds.p:.2g}"
        doubtful = row.seeds.p < DOUBTFUL
    return Line(
        point_words(row.point),
        measured,
        expected,
        deviation,
        seeds,
        row.runs,
        "" if note == shared else note,
        row.number.far,
        doubtful,
    )


def point_words(point: Mapping[str, Any]) -> list[str]:
    """The values of a point.

    >>> point_words({"fluid.timestep": 0.05, "fluid.thermostat.rule": "cell"})
    ['0.05', 'cell']
    """
    return words_of(point.values())


def words_of(values: Iterable[Any]) -> list[str]:
    """Values in short."""
    return [f"{value:g}" if isinstance(value, float) else str(value) for value in values]
