"""Soft spheres, as the rest of the package knows them."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from mesokit.case.case import Case
from mesokit.geometry.walls import closed_axes, solids
from mesokit.method.spheres.common.expected.answers import answers
from mesokit.method.spheres.common.expected.neighbours import NeighboursOfSpheres
from mesokit.method.spheres.common.groups import groups
from mesokit.method.spheres.common.made import made
from mesokit.method.spheres.common.start.first_state import ARRAYS, RUN, first_state, starts
from mesokit.method.spheres.common.start.protocol import Started
from mesokit.method.spheres.common.velocity_memory import VelocityMemory
from mesokit.method.spheres.soft.checks import check
from mesokit.method.spheres.soft.engine.engine import SoftEngine
from mesokit.method.spheres.soft.expected import Displacement, SoftCooling, equilibrium
from mesokit.method.spheres.soft.first_speeds import with_speed
from mesokit.method.spheres.soft.observe import MeanSquareDisplacement
from mesokit.method.spheres.soft.scales import timestep_of
from mesokit.method.spheres.soft.section import KEYS, Sections
from mesokit.method.spheres.soft.summary import summary
from mesokit.seam.method import Columns, Enclosure, InitialState, Method


def _first_state(case: Case, arrays: Mapping[str, Any]) -> Started:
    return first_state(case, made(case), arrays, case.spheres.first_spin_kT)


def _engine(case: Case, threads: int, measures: Sequence[str]) -> SoftEngine:
    case.spheres.require_memory(case.box)
    return SoftEngine(case, threads)


def columns(case: Case) -> Columns:
    """Energies, of which the log of a run may tell."""
    names = ("translation", "rotation", "potential", "contact")

    def read(engine: SoftEngine, wanted: Collection[str]) -> dict[str, float]:
        known = engine.energies()
        return {name: float(known[name]) for name in wanted}

    return Columns(names, ("translation", "potential"), read)


EXPECTED = (SoftCooling, Displacement, NeighboursOfSpheres, VelocityMemory)
METHOD = Method(
    name="soft-spheres",
    sections=Sections,
    keys=KEYS,
    observables=(MeanSquareDisplacement,),
    expected={theory.answers: theory for theory in EXPECTED} | answers(equilibrium),
    check=check,
    groups=groups,
    timestep=timestep_of,
    summary=summary,
    initial=InitialState(_first_state, SoftEngine.start, ARRAYS, starts, RUN, prepared=with_speed),
    engine=_engine,
    enclosure=Enclosure(closed_axes, solids),
    log=columns,
)
