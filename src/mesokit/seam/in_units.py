"""Results and figures in the units of their case, whatever observables write."""

import dataclasses
import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Concatenate, ParamSpec, TypeVar

from mesokit.case.case import Case
from mesokit.seam.method import method_of
from mesokit.seam.result import Result
from mesokit.seam.units import CELLS, Units

P = ParamSpec("P")
T = TypeVar("T")
_SHOWN: ContextVar[Units] = ContextVar("units that figures show", default=CELLS)


def units_of(case: Case) -> Units:
    """Units of the method of a case."""
    return method_of(case).units


def in_units(result: Result, case: Case) -> Result:
    """A result with the names of the units that its case has."""
    units = units_of(case)
    if units == CELLS:
        return result
    named = {name: units.of(unit) for name, unit in result.units.items()}
    comparisons = (dataclasses.replace(c, unit=units.of(c.unit)) for c in result.comparisons)
    return dataclasses.replace(result, units=named, comparisons=tuple(comparisons))


def shown() -> Units:
    """The units of the figure that is being drawn."""
    return _SHOWN.get()


@contextmanager
def showing(case: Case | None) -> Iterator[None]:
    """Figures show the units of a case meanwhile."""
    before = _SHOWN.set(_SHOWN.get() if case is None else units_of(case))
    try:
        yield
    finally:
        _SHOWN.reset(before)


def of_case(draw: Callable[Concatenate[Case, P], T]) -> Callable[Concatenate[Case, P], T]:
    """A function of a case, and more, that draws in the units of that case."""

    @functools.wraps(draw)
    def drawn(case: Case, *given: P.args, **more: P.kwargs) -> T:
        with showing(case):
            return draw(case, *given, **more)

    return drawn
