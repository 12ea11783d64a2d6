"""One number of a study against one value that it varies."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mesokit.case.component import nearest, one_of, show
from mesokit.errors import CaseError
from mesokit.observe.shared.caveats import LOWER_BOUND
from mesokit.seam.result import Comparison
from mesokit.study.axes import Axis
from mesokit.study.dependence import Curve, Theory, draw
from mesokit.study.names import with_symbol
from mesokit.study.numbers import words_of
from mesokit.study.plan import short_names
from mesokit.study.table import Pooled

SHORT = 45  # letters of the name of a theory, or of numbers on one axis


def plot(
    rows: Sequence[Pooled],
    axes: Sequence[Axis],
    key: str,
    number: str,
    called: tuple[str, str] | None = None,
    between: Between | None = None,
    **look: Any,
) -> Any:
    """A figure with error bars, what is expected, and a fit; a curve for each other value.

    `rows` are the table of a study, `axes` what it varies, `key` what the number is drawn against,
    which is `called` so, in a unit; `number` may be several of one unit, with commas between them.
    `between` gives theory between the points; `look` is `fit`, `log` and `width` of
    `dependence.draw`.
    Raises CaseError for a number that is not there, values that are no numbers, and two units.
    """
    drawn = curves_of(rows, axes, key, number, between)
    firsts = [find_rows(rows, name)[0] for name in several(number)]
    runs, unit = firsts[0].runs, firsts[0].number.unit
    note = f"{runs} runs pooled" if runs > 1 else "one run each"
    other = next((row for row in firsts if row.number.unit != unit), None)
    if other is not None:
        units = f"{firsts[0].name} is in {show(unit)} and {other.name} in {show(other.number.unit)}"
        raise CaseError(f"{number}: {units}; expected numbers of one unit")
    names = " and ".join(with_symbol(row.number.what) for row in firsts)
    named = names if len(names) <= SHORT else "", unit  # the legend has them too
    return draw(drawn, x=called or (key, ""), y=named, note=note, **look)


def several(number: str) -> list[str]:
    """The names of numbers that are drawn together.

    >>> several("moduli.storage, moduli.loss")
    ['moduli.storage', 'moduli.loss']
    """
    return [name.strip() for name in number.split(",")]


# of the rows of a curve, the keys of its axis, and whether that is logarithmic
Between = Callable[[Sequence[Pooled], Sequence[str], bool], Theory | None]


def curves_of(
    rows: Sequence[Pooled],
    axes: Sequence[Axis],
    key: str,
    number: str,
    between: Between | None = None,
) -> list[Curve]:
    """One number of the table, or several, against a key that is varied: a curve for each other
    value.

    Raises CaseError as `plot` does.
    """
    names = several(number)
    if len(names) > 1:
        found = {name: find_rows(rows, name)[0].number.what for name in names}
        return [
            curve._replace(label=", ".join(filter(None, [with_symbol(what), curve.label])))
            for name, what in found.items()
            for curve in curves_of(rows, axes, key, name, between)
        ]
    rows = find_rows(rows, number)
    keys = [other for axis in axes for other in axis.keys]
    linked = next(axis.keys for axis in axes if key in axis.keys)
    short = dict(zip(keys, short_names(keys), strict=True))
    curves: dict[str, list[Pooled]] = {}
    for row in rows:
        others = {short[other]: row.point[other] for other in keys if other not in linked}
        words = zip(others, words_of(others.values()), strict=True)
        label = ", ".join(f"{name} = {word}" for name, word in words)
        curves.setdefault(label, []).append(row)
    together = [key, *(other for other in linked if other != key)]
    return [_curve(label, together, group, between) for label, group in curves.items()]


def drawable(rows: Sequence[Pooled], axes: Sequence[Axis]) -> list[str]:
    """The numbers that have error bars at several, numeric, values of the first key."""
    found: dict[str, set[Any]] = {}
    for row in rows:
        if axes and row.number.error > 0:
            found.setdefault(row.name, set()).add(row.point[axes[0].keys[0]])
    if not axes or not all(isinstance(each[0], int | float) for each in axes[0].values):
        return []
    return [name for name, values in found.items() if len(values) > 1]


def find_rows(rows: Sequence[Pooled], name: str) -> list[Pooled]:
    """The rows of one number: by its name, or by its beginning if only one begins so."""
    names = list(dict.fromkeys(row.name for row in rows))
    if not names:
        raise CaseError(f"{name}: no run has ended with a number to draw")
    wanted = name.lower().replace(" ", "-")
    fits = [wanted] if wanted in names else [n for n in names if n.startswith(wanted)]
    if len(fits) != 1:
        known = f"; it may be {one_of(fits)}" if fits else nearest(wanted, names)
        raise CaseError(f"{name}: no such number{known or f'; expected {one_of(names)}'}")
    return [row for row in rows if row.name == fits[0]]


def _curve(label: str, keys: Sequence[str], rows: list[Pooled], between: Between | None) -> Curve:
    key = keys[0]
    values = [row.point[key] for row in rows]
    if not all(isinstance(v, int | float) for v in values):
        raise CaseError(f"{key} = {show(values[0])}: only numbers can be drawn against")
    order = np.argsort(values)
    numbers = [rows[i].number for i in order]
    value, error, expected = np.array([(n.measured, n.error, n.expected) for n in numbers]).T
    seeds = [
        (float(row.point[key]), one.measured, one.error)
        for row in rows
        for one in row.each
        if row.runs > 1 and np.isfinite(one.measured)
    ]
    steady = np.array([number.steady for number in numbers])
    return Curve(
        label,
        np.array(values, float)[order],
        value,
        error,
        expected,
        _theory(numbers),
        between and functools.partial(between, rows, keys),
        np.array(seeds).reshape(-1, 3),
        [
            ("not steady", ~steady),
            ("error bar is a lower bound", np.array([LOWER_BOUND in n.note for n in numbers])),
        ],
        np.array([number.approximate for number in numbers]),
        steady,
    )


def _theory(numbers: Sequence[Comparison]) -> str:
    """The theory where it is not approximate, in a few words."""
    if not all(number.steady for number in numbers):
        return "theory of the steady flow, not reached"
    known = [n for n in numbers if np.isfinite(n.expected) and not n.approximate]
    parts = known[0].note.split("; ") if known else []
    name = "; ".join(part for part in parts if "lower bound" not in part)
    return f"theory, {name}" if 0 < len(name) < SHORT else "theory"
