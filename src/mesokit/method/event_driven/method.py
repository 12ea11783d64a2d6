"""Event-driven dynamics, as the rest of the package knows it."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from mesokit.method.event_driven.checks import check
from mesokit.method.event_driven.cooling import HardCooling
from mesokit.method.event_driven.displacement import Displacement
from mesokit.method.event_driven.engine import EventDriven
from mesokit.method.event_driven.equilibrium import equilibrium
from mesokit.method.event_driven.neighbours import Neighbours
from mesokit.method.event_driven.section import KEYS, Sections
from mesokit.method.event_driven.summary import summary
from mesokit.method.event_driven.velocity_memory import EnskogMemory
from mesokit.method.protocol import Columns, Method
from mesokit.observe.mean_square_displacement import MeanSquareDisplacement
from mesokit.spheres.expected.answers import answers
from mesokit.spheres.groups import FIELDS, groups
from mesokit.spheres.made import made
from mesokit.spheres.start.first_state import ARRAYS, first_state, missing_files, starts
from mesokit.spheres.wall.solids import closed_axes, solids

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.spheres.start.protocol import Started


def _first_state(case: Case, arrays: Mapping[str, Any]) -> Started:
    own = made(case)
    return first_state(case, own, arrays, case.spheres.first_spin_kT)


def _engine(case: Case, threads: int, measures: Sequence[str]) -> EventDriven:
    case.spheres.require_memory(case.box)
    return EventDriven(case, threads, measures)


def columns(case: Case) -> Columns:
    """Energies and numbers of collisions, of which the log of a run may tell."""
    names = ("translation", "rotation", "potential", "collisions", "wall collisions")

    def read(engine: Any, wanted: Collection[str]) -> dict[str, float]:
        pairs, walls, _ = engine.collisions
        known = {**engine.energies(), "collisions": pairs, "wall collisions": walls}
        return {name: float(known[name]) for name in wanted}

    return Columns(names, ("translation", "collisions"), read)


EXPECTED = (HardCooling, Displacement, EnskogMemory, Neighbours)
METHOD = Method(
    name="event-driven",
    sections=Sections,
    keys=KEYS,
    whole_cells=False,
    fields=FIELDS,
    spheres=True,
    picture="disks",
    closed_axes=closed_axes,
    solids=solids,
    observables=(MeanSquareDisplacement,),
    expected={theory.answers: theory for theory in EXPECTED} | answers(equilibrium),
    check=check,
    groups=groups,
    timestep=lambda case: float(case.spheres.timestep),
    kT=lambda case: float(case.spheres.kT),
    summary=summary,
    starts=starts,
    missing_files=missing_files,
    arrays=ARRAYS,
    first_state=_first_state,
    engine=_engine,
    start=EventDriven.start,
    log=columns,
)
