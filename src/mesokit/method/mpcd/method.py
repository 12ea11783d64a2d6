"""Multi-particle collision dynamics: the record of the method, and the sections of its cases.

It imports engines, observables and files, and is loaded by name.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import param
from mesokit.case.describe.hints import Many
from mesokit.devices.device import Device
from mesokit.errors import CaseError
from mesokit.geometry.samples.from_file import FromFile
from mesokit.geometry.shape import Wall
from mesokit.geometry.solids.solids import solids_of
from mesokit.geometry.walls import solids
from mesokit.method.mpcd.body import Body
from mesokit.method.mpcd.checks import combinations
from mesokit.method.mpcd.columns import columns
from mesokit.method.mpcd.derived import build_up, heat_caveat, summary
from mesokit.method.mpcd.expected.displacement import Displacement
from mesokit.method.mpcd.expected.neighbours import NeighboursInFluid
from mesokit.method.mpcd.expected.setting import closed_axes
from mesokit.method.mpcd.expected.velocities import Velocities
from mesokit.method.mpcd.expected.velocity_memory import VelocityMemory
from mesokit.method.mpcd.fluid import Fluid
from mesokit.method.mpcd.groups import body_shapes, bonded_pairs, groups
from mesokit.method.mpcd.observe import Observable
from mesokit.method.mpcd.observe.shared.density_in_slices import DensityInSlices
from mesokit.method.mpcd.observe.shared.flow_in_slices import FlowInSlices
from mesokit.method.mpcd.observe.shared.temperature_in_slices import TemperatureInSlices
from mesokit.method.mpcd.si import convert
from mesokit.method.mpcd.solutes import Solutes
from mesokit.processes.world import world
from mesokit.seam.engine import Engine
from mesokit.seam.method import (
    Enclosure,
    InitialState,
    Method,
    OnDevices,
    Row,
    Steadiness,
)
from mesokit.seam.units import CELLS

if TYPE_CHECKING:
    from mesokit.method.mpcd.start.first_state import FirstState


def _first_state(case: Case, arrays: Mapping[str, Any]) -> FirstState:
    from mesokit.method.mpcd.start.first_state import first_state

    return first_state(case, **arrays, here=world())


def _engine(case: Case, threads: int, measures: Sequence[str]) -> Engine:
    from mesokit.method.mpcd.engine.cpu.engine import CPU

    here = world()
    if here.size == 1:
        return CPU(case, threads, measures)
    from mesokit.method.mpcd.engine.domains.engine import Ranks

    return Ranks(case, threads, measures, here.comm)


def _engine_on(case: Case, device: Device, measures: Sequence[str]) -> Engine:
    from mesokit.method.mpcd.engine.cuda.engine import CUDA

    return CUDA(case, device, measures)


def _refused_on_devices(case: Case, ranks: int) -> Iterator[str]:
    from mesokit.method.mpcd.engine.cuda.refused import refused

    return refused(case, ranks)


def _rows_on_devices(case: Case) -> Sequence[Row]:
    from mesokit.method.mpcd.engine.cuda.cost import rows

    return rows(case)


def _check_ranks(case: Case, ranks: int) -> None:
    """Refuse cases that need all particles in one memory, or have fewer cells than ranks."""
    from mesokit.method.mpcd.engine.cpu.numbers import Numbers
    from mesokit.method.mpcd.engine.domains.blocks.tree import divided
    from mesokit.method.mpcd.engine.domains.domain import axes_to_cut

    if case.solutes is not None and case.solutes.coupling == "potential":
        raise CaseError(
            f"solutes.coupling = 'potential': not on {ranks} ranks; expected one rank, or "
            "coupling = 'collision'"
        )
    numbers = Numbers(case)
    try:
        divided(numbers.cells, ranks, axes_to_cut(numbers))
    except ValueError as error:
        size = " x ".join(str(n) for n in numbers.cells)
        raise CaseError(f"{ranks} ranks: too many for {size} cells: {error}") from None


def _start(engine: Any, state: FirstState) -> None:
    from mesokit.method.mpcd.start.fluid import start

    start(engine, *state)


def _starts(case: Case) -> dict[str, Path]:
    starts: dict[str, Any] = {"fluid.start": case.fluid.start}
    if case.solutes is not None:
        starts["solutes.start"] = case.solutes.start
    starts |= {f"bodies[#{n}].start": kind.start for n, kind in enumerate(case.bodies, start=1)}
    return {
        f"{where}.{key}": Path(name)
        for where, start in starts.items()
        for key in ("positions", "orientations", "velocities", "spins", "run", "file")
        if isinstance(name := getattr(start, key, None), str)
    }


def _keep_files(case: Case, folder: Path) -> Case:
    from mesokit.io.part_files import kept, kept_part, kept_row

    case = kept_part(case, "fluid.force", folder)
    if not case.fluid.force.steady:
        case = kept_part(case, "fluid.force.of", folder)
    for key in ("fluid.molecule.pair", "solutes.pair", "solutes.wall", "solutes.solvent_pair"):
        case = kept_part(case, key, folder)
    if (solutes := case.solutes) is not None:  # and the potentials of single kinds
        kinds = kept_row(solutes.polymers, "pair", "polymer", folder)
        between = kept_row(solutes.between, "pair", "between", folder)
        if kinds is not solutes.polymers or between is not solutes.between:
            solutes = dataclasses.replace(solutes, polymers=kinds, between=between)
        case = dataclasses.replace(case, solutes=solutes)
    if not any(isinstance(wall, FromFile) for wall in case.walls):
        return case
    return dataclasses.replace(case, walls=kept(case.walls, solids_of(case), folder))


KEYS = {"walls": "wall"}  # field -> key in the file, where they differ: one [[wall]] each


class Sections:
    """Sections of a case of MPCD beside those of every case."""

    fluid: Fluid = param(Fluid(), doc="the fluid")
    solutes: Solutes | None = param(None, doc="monomers and polymers in the fluid (none)")
    bodies: Many[Body] = param((), doc="rigid bodies that move in the fluid, `[[bodies]]`")
    walls: Many[Wall] = param((), doc="walls; key `[[wall]]` in a file")


ARRAYS = ("positions", "velocities", "beads", "bead_velocities")
METHOD = Method(
    name="mpcd",
    sections=Sections,
    keys=KEYS,
    box=("shear_rate", "shear_frequency", "open", "shear"),
    observables=(Observable,),
    check=combinations.check,
    groups=groups,
    bonds=bonded_pairs,
    bodies=body_shapes,
    enclosure=Enclosure(lambda c: closed_axes(c) | {AXES.index(a) for a in c.box.open}, solids),
    timestep=lambda case: float(case.fluid.timestep),
    summary=summary,
    initial=InitialState(
        _first_state, _start, ARRAYS, _starts, "fluid.start.run", kept=_keep_files
    ),
    engine=_engine,
    on_devices=OnDevices(_engine_on, _refused_on_devices, _rows_on_devices),
    expected={
        theory.answers: theory
        for theory in (
            DensityInSlices,
            Displacement,
            FlowInSlices,
            NeighboursInFluid,
            TemperatureInSlices,
            Velocities,
            VelocityMemory,
        )
    },
    log=columns,
    si=convert,
    steadiness=Steadiness(build_up, heat_caveat),
    units=CELLS,
    check_ranks=_check_ranks,
)
