"""Event-driven dynamics, as the rest of the package knows it."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from mesokit.case.case import Case
from mesokit.geometry.walls import closed_axes, solids
from mesokit.method.spheres.common.expected.answers import answers
from mesokit.method.spheres.common.groups import groups
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.start.first_state import ARRAYS, RUN, first_state, starts
from mesokit.method.spheres.common.start.protocol import Started
from mesokit.method.spheres.hard.checks import check
from mesokit.method.spheres.hard.engine.engine import EventDriven
from mesokit.method.spheres.hard.expected import (
    Displacement,
    EnskogMemory,
    HardCooling,
    Neighbours,
    equilibrium,
)
from mesokit.method.spheres.hard.observe import MeanSquareDisplacement
from mesokit.method.spheres.hard.section import KEYS, Sections
from mesokit.method.spheres.hard.summary import summary
from mesokit.seam.method import Columns, Enclosure, InitialState, Method


def _first_state(case: Case, arrays: Mapping[str, Any]) -> Started:
    own = made(case)
    return first_state(case, own, arrays, case.spheres.first_spin_kT)


def _engine(case: Case, threads: int, measures: Sequence[str]) -> EventDriven:
    case.spheres.require_memory(case.box)
    return EventDriven(case, threads, measures)


def columns(case: Case) -> Columns:
    """Energies and numbers of collisions, of which the log of a run may tell."""
    names = ("translation", "rotation", "potential", "collisions", "wall collisions")

    def read(engine: EventDriven, wanted: Collection[str]) -> dict[str, float]:
        pairs, walls, _ = engine.collisions
        known = {**engine.energies(), "collisions": pairs, "wall collisions": walls}
        return {name: float(known[name]) for name in wanted}

    return Columns(names, ("translation", "collisions"), read)


EXPECTED = (HardCooling, Displacement, EnskogMemory, Neighbours)
METHOD = Method(
    name="event-driven",
    sections=Sections,
    keys=KEYS,
    observables=(MeanSquareDisplacement,),
    expected={theory.answers: theory for theory in EXPECTED} | answers(equilibrium),
    check=check,
    groups=groups,
    timestep=lambda case: float(case.spheres.timestep),
    summary=summary,
    initial=InitialState(_first_state, EventDriven.start, ARRAYS, starts, RUN),
    engine=_engine,
    enclosure=Enclosure(closed_axes, solids),
    log=columns,
)
