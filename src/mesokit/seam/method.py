"""The record of a method of simulation, by which the rest of the package uses it."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from mesokit.case import methods
from mesokit.case.amounts import duration_text
from mesokit.case.case import Case
from mesokit.case.component import show
from mesokit.case.trajectory import Group
from mesokit.devices.device import Device
from mesokit.errors import CaseError
from mesokit.processes.cores import usable_cores
from mesokit.seam.engine import Engine
from mesokit.seam.observable import Observable
from mesokit.seam.units import Units

if TYPE_CHECKING:
    from mesokit.geometry.region import Part
    from mesokit.geometry.solids.solids import Solids

E = TypeVar("E")  # engine of a method
S = TypeVar("S")  # state that it starts from
Floats = NDArray[np.floating]
Row = tuple[str, str, str]  # what, its value, and a word on it


class OnDevices(NamedTuple):
    """How a method runs on a device (see `mesokit.devices`).

    `engine` is a function of a case, a device and what observables need measured. `refused` says,
    for each thing in a case, on so many ranks, what devices cannot do. `rows` are those of
    `mesokit check` about memory and time on a device.
    """

    engine: Callable[[Case, Device, Sequence[str]], Engine]
    refused: Callable[[Case, int], Iterator[str]]
    rows: Callable[[Case], Sequence[Row]]


class Summary(NamedTuple):
    """Summary of a case before it runs: a table for `mesokit check`, warnings, about how
    many seconds the run takes, the same as plain numbers by name, for scripts, and about how many
    bytes of memory it takes."""

    rows: tuple[Row, ...]
    warnings: tuple[str, ...]
    seconds: float
    numbers: Mapping[str, object] = MappingProxyType({})
    memory: float = 0.0

    def record(self) -> dict[str, object]:
        """The part that `mesokit check --json` prints."""
        rows = [{"what": what, "value": value, "note": note} for what, value, note in self.rows]
        return {
            "numbers": dict(self.numbers),
            "rows": rows,
            "warnings": list(self.warnings),
            "seconds": self.seconds,
        }


class Columns(NamedTuple, Generic[E]):
    """Columns of a log: all names, those that are usual, and how to read some in an engine."""

    names: tuple[str, ...]
    usual: tuple[str, ...]
    read: Callable[[E, Collection[str]], Mapping[str, float]]


SELDOM = 20  # steps between samples, from which on they cost little beside the steps
NO_COLUMNS: Columns[object] = Columns((), (), lambda engine, wanted: {})


class BuildUp(NamedTuple):
    """How a flow from rest comes to its steady state: what it lacks falls as an exponential.

    steps: in which that falls to 1/e; need: the wait before the first sample that `mesokit check`
    recommends; had: that the run waited.
    """

    steps: float
    need: int
    had: int

    def lacks(self, length: float) -> float:
        """The part of the steady flow that the mean over so many steps lacks.

        >>> round(BuildUp(1200.0, 3600, 100).lacks(500), 2)
        0.75
        """
        left = math.exp(-self.had / self.steps)
        return left * -math.expm1(-length / self.steps) * self.steps / length


class InitialState(NamedTuple, Generic[E, S]):
    """First state of a case.

    read: of a case and arrays by name, what to start from, checked; raises CaseError. Whatever it
    returns goes to `fill`, which puts it into an engine. arrays: names of those that a `Simulation`
    may be started from. files: the files and folders of runs that a case starts from, by their
    keys. run: the key by which a case starts from where another run ended. prepared: the case with
    keys that follow from the state it starts from; raises CaseError. kept: of a case and the folder
    of its run, the case with copies in that folder of the files that it was made from.
    """

    read: Callable[[Case, Mapping[str, object]], S]
    fill: Callable[[E, S], None]
    arrays: tuple[str, ...] = ()
    files: Callable[[Case], Mapping[str, Path]] = lambda case: {}
    run: str = ""
    prepared: Callable[[Case, Mapping[str, object]], Case] = lambda case, arrays: case
    kept: Callable[[Case, Path], Case] = lambda case, folder: case

    def missing(self, case: Case) -> list[str]:
        """A line for each file or folder that is not there."""
        return [
            f"{key} = {show(str(path), 500)}: no such {'folder' if key.endswith('run') else 'file'}"
            for key, path in self.files(case).items()
            if not path.exists()
        ]


class Plate(NamedTuple):
    """A plate that moves: a point of it at rest, its normal, and its displacement along this."""

    point: Floats
    normal: Floats
    shift: float

    def moved(self, points: Floats, distance: Floats) -> Floats:
        """Distances (n,) of points (n, d) from all surfaces, from those with this plate at rest."""
        rest = (points - self.point) @ self.normal
        nearest = np.isclose(distance, rest, rtol=0, atol=1e-9)
        return np.where(nearest, rest - self.shift, np.minimum(distance, rest - self.shift))


def absorbed_words(time: float | None) -> str:
    """A line on the time after which nothing can happen; "" while something can.

    >>> absorbed_words(12.345678), absorbed_words(None)
    ('after t = 12.3457 nothing can happen any more', '')
    """
    return "" if time is None else f"after t = {time:.6g} nothing can happen any more"


class Steadiness(NamedTuple):
    """How far a run measures a steady state, as functions of a case.

    build_up: how its flow comes from rest to its steady state, or None. heat_caveat: of the number
    of steps too, warm-up included: the caveat of numbers that depend on the temperature, where so
    many steps heat the particles far above that of theory; "" elsewhere.
    """

    build_up: Callable[[Case], BuildUp | None] = lambda case: None
    heat_caveat: Callable[[Case, int], str] = lambda case, steps: ""


class Enclosure(NamedTuple):
    """Enclosure of particles, as functions of a case: numbers of the axes that are not periodic,
    the solids that pictures show (`mesokit.geometry.solids.solids.Solids`) or None, the plates
    that are not where they are at rest at a time, and those that particles push, with the numbers
    of their surfaces."""

    closed_axes: Callable[[Case], set[int]] = lambda case: set()
    solids: Callable[[Case], Solids | None] = lambda case: None
    moving_plates: Callable[[Case, float], tuple[Plate, ...]] = lambda case, time: ()
    pushed_plates: Callable[[Case], Sequence[tuple[int, Plate]]] = lambda case: ()


class BodyShape(NamedTuple):
    """Shape of a kind of bodies that move: convex parts about its centre, in its own frame.

    radius: of the smallest sphere about the centre that holds it; forward: of a body that swims, or
    that a force along its own axes drives, from the centre to its front; () of others.
    """

    parts: tuple[Part, ...]
    radius: float
    forward: tuple[float, ...] = ()


NOT_ENCLOSED, STEADY = Enclosure(), Steadiness()


class InSI(Protocol):
    """Units of a case in SI; its text is the table that `mesokit check` shows."""

    def record(self) -> Mapping[str, object]:
        """The same as plain numbers by name, for the record of a run."""


@dataclass(frozen=True)
class Method:
    """A method of simulation.

    Parameters
    ----------
    name : str
        The value of `run.method`.
    sections : class
        Its annotated fields, made by `param`, are the sections of its cases.
    observables : sequence of type
        The observables that it offers, or bases of them. Others may name it in `methods`.
    check : function of a case
        Raises CaseError for values that are fine alone and have no physics together.
    groups : function of a case
        The groups of its particles or sites, in the order of their numbers, and the quantities of
        each (`mesokit.case.trajectory.Group`).
    timestep : function of a case
        The time that a step takes.
    summary : function of a case and a number of threads (None: all cores)
        Derived numbers, estimated cost and warnings.
    initial : InitialState
        What a case starts from.
    engine : function of a case, a number of threads and what observables need measured
        The engine, with nothing in it yet.
    on_devices : OnDevices, optional
        The same on a device; without it, the method runs on processors alone.
    dimensions : sequence of int, optional
        How many axes its box may have (two or three unless said).
    box : sequence of str, optional
        Keys of the box that it takes beside `size`; all others are refused.
    keys : mapping, optional
        Names of sections as they are in a file where these differ from those in Python: of a list
        of tables, `[[wall]]` for `walls`.
    expected : mapping, optional
        By the name of an observable that several methods share, what theory expects of it:
        a function of a case and the observable, whose answer that observable's file describes.
    enclosure : Enclosure, optional
        What shuts its particles in.
    bonds : function of a case, optional
        Pairs (bonds, 2) of the numbers of particles that are bonded.
    bodies : function of a case, optional
        Shapes of bodies that move, for pictures: one for each kind of the group that has an
        "orientation".
    log : function of a case, optional
        The columns of the log of its run.
    si : function of a case, optional
        What its units are in SI; without it, a case must not have the section `[units]`.
    steadiness : Steadiness, optional
        How far a run measures a steady state.
    absorbed : function of an engine, optional
        The time after which nothing can happen any more, None while something can.
    units : Units, optional
        What lengths, times and masses are counted in; unless said, the unit of the case.
    most_threads : function of a case, optional
        The number of threads beyond which another one gains nothing; a run has no more unless said.
    check_ranks : function of a case and a number of ranks, optional
        Raises CaseError for a case that cannot be run on so many ranks of MPI; without it, none
        can. All ranks then call its engine at once.
    """

    name: str
    sections: type
    observables: tuple[type, ...]
    check: Callable[[Case], None]
    groups: Callable[[Case], tuple[Group, ...]]
    timestep: Callable[[Case], float]
    summary: Callable[[Case, int | None], Summary]
    initial: InitialState[Any, Any]
    engine: Callable[[Case, int, Sequence[str]], Engine]
    on_devices: OnDevices | None = None
    dimensions: tuple[int, ...] = (2, 3)
    box: tuple[str, ...] = ()
    keys: Mapping[str, str] = field(default_factory=dict)
    expected: Mapping[str, Callable[[Case, Observable], Any]] = field(default_factory=dict)
    enclosure: Enclosure = NOT_ENCLOSED
    bonds: Callable[[Case], NDArray[np.int64]] = lambda case: np.zeros((0, 2), np.int64)
    bodies: Callable[[Case], tuple[BodyShape, ...]] = lambda case: ()
    log: Callable[[Case], Columns[Any]] = lambda case: NO_COLUMNS
    si: Callable[[Case], InSI] | None = None
    steadiness: Steadiness = STEADY
    absorbed: Callable[[Any], float | None] = lambda engine: None
    units: Units = Units()  # noqa: RUF009  a tuple of names
    most_threads: Callable[[Case], int] | None = None
    check_ranks: Callable[[Case, int], None] | None = None


def method_of(case: Case) -> Method:
    """The method of a case."""
    found: Method = methods.load(case.run.method)
    return found


def on_devices(case: Case, device: str, ranks: int) -> OnDevices:
    """How the method of a case runs on a device. Raises CaseError where it cannot."""
    found = method_of(case).on_devices
    if found is None:
        method = show(case.run.method)
        raise CaseError(f"device = {show(device)}: not for run.method = {method}; expected 'cpu'")
    for said in found.refused(case, ranks):
        raise CaseError(f"device = {show(device)}: {said}")
    return found


def summary_of(case: Case, threads: int | None = None) -> Summary:
    """Summary of a case by its method; the run time of replicas is that of all of them."""
    summary, number, seed = method_of(case).summary, case.run.replicas, case.run.seed
    if number == 1:
        found = summary(case, threads)
    else:
        cores = usable_cores() if threads is None else threads
        one = summary(case, max(1, cores // number))
        seconds, all_rows = one.seconds * math.ceil(number / cores), []
        for name, value, note in one.rows:
            if name == "run time":
                value, note = duration_text(seconds), f"estimate: of all, {cores} threads"
            all_rows.append((name, value, "estimate: of each" if name == "memory" else note))
        replicas = ("replicas", str(number), f"seeds {seed} to {seed + number - 1}, side by side")
        numbers = {**one.numbers, "replicas": number}
        memory = one.memory * number
        found = Summary((replicas, *all_rows), one.warnings, seconds, numbers, memory)
    often = {one.label: one.every for one in case.observe if one.every < SELDOM}
    if not often:
        return found
    # the estimate of the run time hardly counts samples, which are frequent here
    every = min(often.values())
    what = next(iter(often)) if len(often) == 1 else f"{len(often)} observables"
    steps = "every step" if every == 1 else f"every {every} steps"
    more = f"; samples of {what}, up to {steps}, may add much to it"
    rows = [(*row[:2], row[2] + more if row[0] == "run time" else row[2]) for row in found.rows]
    return found._replace(rows=tuple(rows))
