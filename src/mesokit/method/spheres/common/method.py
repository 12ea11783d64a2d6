"""The record of a method of spheres: its parts that do not depend on how spheres move."""

from collections.abc import Callable, Collection, Sequence
from typing import Any

from mesokit.case.case import Case
from mesokit.geometry.walls import closed_axes, solids
from mesokit.method.spheres.common.engine import SphereEngine
from mesokit.method.spheres.common.expected.answers import answers
from mesokit.method.spheres.common.groups import groups
from mesokit.method.spheres.common.section import KEYS
from mesokit.method.spheres.common.start.first_state import (
    ARRAYS,
    RUN,
    Started,
    first_state,
    starts,
)
from mesokit.method.spheres.common.walls import moving_plates, pushed_plates
from mesokit.seam.method import Columns, Enclosure, InitialState, Method


def sphere_method(
    engine: Callable[[Case, int, Sequence[str]], Any],
    equilibrium: Callable[[Case], Any],
    theories: Sequence[Any],
    prepared: Callable[..., Case] = lambda case, arrays: case,
    **own: Any,
) -> Method:
    """A method by the class of its engine, its theories, and `own` fields of `Method`."""

    def make(case: Case, threads: int, measures: Sequence[str]) -> Any:
        case.spheres.require_memory(case.box)
        return engine(case, threads, measures)

    def fill(spheres: SphereEngine, state: Started) -> None:
        spheres.start(state)

    return Method(
        keys=KEYS,
        expected={theory.answers: theory for theory in theories} | answers(equilibrium),
        groups=groups,
        initial=InitialState(first_state, fill, ARRAYS, starts, RUN, prepared),
        engine=make,
        enclosure=Enclosure(closed_axes, solids, moving_plates, pushed_plates),
        **own,
    )


def log_columns(*names: str, usual: tuple[str, ...]) -> Callable[[Case], Columns]:
    """Columns of the log of a run: numbers of `SphereEngine.logged` by name."""

    def read(engine: SphereEngine, wanted: Collection[str]) -> dict[str, float]:
        known = engine.logged()
        return {name: float(known[name]) for name in wanted}

    return lambda case: Columns(names, usual, read)
