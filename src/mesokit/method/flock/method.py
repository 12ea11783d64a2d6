"""Flocks, as the record by which the package runs them."""

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

import numpy as np

from mesokit.case.case import Case
from mesokit.case.trajectory import Group, Kind
from mesokit.geometry.walls import closed_axes, solids
from mesokit.method.flock.checks import check, room_in_memory
from mesokit.method.flock.engine.flocks import Flocks
from mesokit.method.flock.expected import Displacement
from mesokit.method.flock.observe import FlockObservable
from mesokit.method.flock.section import KEYS, Sections
from mesokit.method.flock.start import first_state
from mesokit.method.flock.summary import summary
from mesokit.observe.mean_square_displacement import MeanSquareDisplacement
from mesokit.seam.method import Columns, Enclosure, InitialState, Method

STARTS = ("positions", "velocities", "run", "file")


def groups(case: Case) -> tuple[Group, ...]:
    """One group of birds, without a mass of their own: it is written as 1."""
    has = ("position", "velocity", "image", "id", "heading")
    return (Group("birds", (Kind(1.0, case.flock.birds(case.box)),), has, picture="flock"),)


def columns(case: Case) -> Columns:
    """Polar order and mean heading, of which the log of a run may tell."""
    names = ("order", *(f"heading {axis}" for axis in case.box.axes))

    def read(engine: Flocks, wanted: Collection[str]) -> dict[str, float]:
        mean = engine.headings().mean(axis=0)
        values = dict(zip(names, (float(np.linalg.norm(mean)), *map(float, mean)), strict=True))
        return {name: values[name] for name in wanted}

    return Columns(names, names[:1], read)


def _engine(case: Case, threads: int, measures: Sequence[str]) -> Flocks:
    room_in_memory(case)
    return Flocks(case, threads)


def _files(case: Case) -> Mapping[str, Path]:
    given = {key: getattr(case.flock.start, key) for key in STARTS}
    return {f"flock.start.{key}": Path(name) for key, name in given.items() if name is not None}


METHOD = Method(
    name="flock",
    sections=Sections,
    keys=KEYS,
    observables=(MeanSquareDisplacement, FlockObservable),
    expected={"mean-square-displacement": Displacement},
    check=check,
    groups=groups,
    timestep=lambda case: float(case.flock.timestep),
    summary=summary,
    enclosure=Enclosure(closed_axes, solids),
    initial=InitialState(
        first_state,
        lambda engine, state: engine.start(*state),
        ("positions", "velocities"),
        _files,
        "flock.start.run",
    ),
    engine=_engine,
    log=columns,
)
