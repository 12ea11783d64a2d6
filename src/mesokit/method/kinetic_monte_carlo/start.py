"""First states of the sites: drawn, in a pattern, from a file or from an earlier run."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from mesokit.case.case import Case
from mesokit.case.component import component, nearest, one_of, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.case.given.array_file import EXPECTED, array_in_file
from mesokit.case.given.file import FileName
from mesokit.case.registry import family
from mesokit.errors import CaseError, MesokitError
from mesokit.io.earlier_run import earlier_state

States = NDArray[np.integer[Any]]
DRAW = 91  # purpose of the random numbers here: with the seed, the key of the generator


@family("start of a lattice", "rule", "mesokit.lattice_start")
@component
class LatticeStart(ABC):
    """The first state of each site."""

    @abstractmethod
    def states(self, case: Case) -> States:
        """States (n,) by number of the site. Raises CaseError."""


@component
class UniformStart(LatticeStart):
    """All sites in one state."""

    rule: Literal["uniform"] = tag("uniform")
    state: str | None = param(None, doc="name of the state (the first unless said)")

    def states(self, case: Case) -> States:
        return np.full(sites_of(case), _number(case, "state", self.state, 0), kind_of(case))


@component
class RandomStart(LatticeStart):
    """Each site in a state of its own, drawn at random."""

    rule: Literal["random"] = tag("random")
    fractions: Many[float] = param(
        (), doc="of sites in each state, with the sum 1 (all alike unless said)"
    )
    exact: bool = param(
        False, doc="true: as many sites in each state as the fractions say, not only on average"
    )

    @model_validator(mode="after")
    def _sum(self) -> RandomStart:
        _parts_of_one(self.fractions)
        return self

    def states(self, case: Case) -> States:
        names, n = case.lattice.model.states(), sites_of(case)
        if not names:
            raise CaseError("lattice.start.rule = 'random': not for heights; expected 'uniform'")
        if self.fractions and len(self.fractions) != len(names):
            raise CaseError(
                f"lattice.start.fractions = {show(list(self.fractions))}: expected {len(names)} "
                f"numbers, one for each of {one_of(names)}"
            )
        shares = np.array(self.fractions or [1 / len(names)] * len(names))
        edges = shares.cumsum()[:-1]
        drawn = np.random.Generator(np.random.Philox(key=[case.run.seed, DRAW])).random(n)
        if self.exact:  # in the order of their numbers: as many as the fractions say
            drawn = (np.argsort(np.argsort(drawn)) + 0.5) / n
        return np.searchsorted(edges, drawn, side="right").astype(kind_of(case))


@component
class SlabStart(LatticeStart):
    """The sites in a slab, from 0 along an axis, in one state, the others in another."""

    rule: Literal["slab"] = tag("slab")
    axis: Literal["x", "y", "z"] = param("x", doc="axis across it")
    part: float = param(0.5, doc="its length over that of the box", gt=0, lt=1)
    state: str | None = param(None, doc="name of the state within (the second unless said)")
    beyond: str | None = param(None, doc="name of the state beyond (the first unless said)")

    def states(self, case: Case) -> States:
        axis, size = case.box.index(self.axis, "lattice.start.axis"), case.box.size
        before = np.indices(size)[axis].ravel() < round(self.part * size[axis])
        first = _number(case, "state", self.state, 1)
        return np.where(before, first, _number(case, "beyond", self.beyond, 0)).astype(
            kind_of(case)
        )


@component
class DropletStart(LatticeStart):
    """The sites within a radius of the middle in one state, the others in another."""

    rule: Literal["droplet"] = tag("droplet")
    radius: float = param(doc="in distances of neighbours", gt=0)
    state: str | None = param(None, doc="name of the state within (the second unless said)")
    beyond: str | None = param(None, doc="name of the state around (the first unless said)")

    def states(self, case: Case) -> States:
        places = case.lattice.lattice.places(tuple(map(int, case.box.size)))
        middle = 0.5 * (places.min(axis=0) + places.max(axis=0))
        inside = ((places - middle) ** 2).sum(axis=1) <= self.radius**2
        first = _number(case, "state", self.state, 1)
        return np.where(inside, first, _number(case, "beyond", self.beyond, 0)).astype(
            kind_of(case)
        )


@component
class GrainsStart(LatticeStart):
    """Two grains that touch in the middle of the box: disks in a plane, balls in space."""

    rule: Literal["grains"] = tag("grains")
    radius: float = param(doc="of each, in distances of neighbours", ge=1)
    axis: Literal["x", "y", "z"] = param("x", doc="axis from one to the other")
    state: str | None = param(None, doc="name of the state within (the second unless said)")
    beyond: str | None = param(None, doc="name of the state around (the first unless said)")

    def states(self, case: Case) -> States:
        axis = case.box.index(self.axis, "lattice.start.axis")
        places = case.lattice.lattice.places(tuple(map(int, case.box.size)))
        low, high = places.min(axis=0), places.max(axis=0)
        needed = np.full(len(low), 2 * self.radius)
        needed[axis] *= 2
        if (high - low < needed - 1).any():
            raise CaseError(
                f"lattice.start.radius = {show(self.radius)}: two grains need "
                f"{show(needed.tolist())} distances of neighbours; expected a larger box.size"
            )
        inside = np.zeros(len(places), bool)
        for sign in (-1, 1):
            middle = 0.5 * (low + high)
            middle[axis] += sign * self.radius
            inside |= ((places - middle) ** 2).sum(axis=1) <= self.radius**2
        first = _number(case, "state", self.state, 1)
        return np.where(inside, first, _number(case, "beyond", self.beyond, 0)).astype(
            kind_of(case)
        )


@component
class NucleusStart(LatticeStart):
    """A cluster to grow from: one site in the middle, or the line or plane of sites at 0.

    The other sites are in the first state, or in states that are drawn.
    """

    rule: Literal["nucleus"] = tag("nucleus")
    axis: Literal["x", "y", "z"] | None = param(
        None, doc="axis across a line, or a plane, at 0 (one site unless said)"
    )
    state: str | None = param(None, doc="name of its state (the last unless said)")
    fractions: Many[float] = param(
        (), doc="of the other sites in each state, with the sum 1 (all in the first unless said)"
    )

    @model_validator(mode="after")
    def _sum(self) -> NucleusStart:
        _parts_of_one(self.fractions)
        return self

    def states(self, case: Case) -> States:
        names, size = case.lattice.model.states(), tuple(map(int, case.box.size))
        if not names:
            raise CaseError("lattice.start.rule = 'nucleus': not for heights; expected 'terrace'")
        first = (1.0, *(0.0 for _ in names[1:]))
        around = RandomStart(fractions=self.fractions or first).states(case)
        found = around.reshape(size)
        state = _number(case, "state", self.state, len(names) - 1)
        if self.axis is None:
            found[tuple(length // 2 for length in size)] = state
        else:
            axis = case.box.index(self.axis, "lattice.start.axis")
            np.moveaxis(found, axis, 0)[0] = state
        return around


@component
class TerraceStart(LatticeStart):
    """Two terraces: columns up to a part of the length along an axis are higher than the others."""

    rule: Literal["terrace"] = tag("terrace")
    height: int = param(1, doc="of the step, in atoms", ge=1, le=10**6)
    axis: Literal["x", "y", "z"] = param("x", doc="axis across it")
    part: float = param(0.5, doc="length of the high columns over that of the box", gt=0, lt=1)

    def states(self, case: Case) -> States:
        if case.lattice.model.states():
            raise CaseError("lattice.start.rule = 'terrace': of heights; expected 'slab'")
        axis, size = case.box.index(self.axis, "lattice.start.axis"), case.box.size
        before = np.indices(size)[axis].ravel() < round(self.part * size[axis])
        return np.where(before, self.height, 0).astype(kind_of(case))


@component
class AlternatingStart(LatticeStart):
    """Neighbours in two states, in turn: heights 0 and 1 of the single-step model."""

    rule: Literal["alternating"] = tag("alternating")

    def states(self, case: Case) -> States:
        if case.lattice.kind not in ("chain", "square", "honeycomb", "cubic"):
            raise CaseError(
                "lattice.start.rule = 'alternating': expected a chain, a square, a "
                "honeycomb or a cubic lattice"
            )
        for axis, length in zip(case.box.axes, case.box.size, strict=True):
            if length % 2 and axis not in case.lattice.ends:
                raise CaseError(
                    f"box.size = {show(list(case.box.size))}: expected an even number along "
                    f"{axis} for lattice.start.rule = 'alternating'"
                )
        return (np.indices(case.box.size).sum(axis=0).ravel() % 2).astype(kind_of(case))


@component
class FileStart(LatticeStart):
    """States from a file."""

    rule: Literal["file"] = tag("file")
    file: FileName = param(doc="file .npy with the number of the state of each site, as the box")

    def states(self, case: Case) -> States:
        key = f"lattice.start.file = {show(self.file, 500)}"
        try:
            found = array_in_file(self.file, "states", tuple(map(int, case.box.size)))
        except OSError as error:
            raise CaseError(f"{key}: {EXPECTED}: {error.strerror}") from None
        except ValueError as error:
            raise CaseError(f"{key}: {error}") from None
        return checked(case, key, found)


@component
class RunStart(LatticeStart):
    """States from the last checkpoint of an earlier run, with the clock at 0."""

    rule: Literal["run"] = tag("run")
    run: FileName = param(doc="folder of the run; of replicas, the first")

    def states(self, case: Case) -> States:
        key = f"lattice.start.run = {show(self.run, 500)}"
        try:
            state = earlier_state(case, self.run)
        except (OSError, MesokitError) as error:
            raise CaseError(f"{key}: {error}") from None
        return checked(case, key, state["states"])


def _parts_of_one(fractions: tuple[float, ...]) -> None:
    """Raise ValueError unless fractions are none, or numbers from 0 with the sum 1."""
    if fractions and (min(fractions) < 0 or abs(sum(fractions) - 1) > 1e-9):
        raise ValueError(
            f"fractions = {show(list(fractions))}: expected numbers from 0 with the sum 1"
        )


def kind_of(case: Case) -> type[np.integer]:
    """The type of a state in memory: a byte, or 32 bits for heights."""
    return np.uint8 if case.lattice.model.states() else np.int32


def sites_of(case: Case) -> int:
    """How many sites a case has."""
    return int(np.prod(case.box.size))


def checked(case: Case, key: str, found: Any) -> States:
    """States (n,) that were given. Raises CaseError for numbers that are those of no state."""
    try:
        array = np.asarray(found)
    except (TypeError, ValueError):
        raise CaseError(f"{key}: expected an array of whole numbers") from None
    if array.dtype.kind not in "iub":
        raise CaseError(f"{key}: expected whole numbers, not {array.dtype.name}")
    if array.size != sites_of(case):
        raise CaseError(f"{key}: shape {array.shape}: expected {tuple(case.box.size)}")
    flat, names = array.ravel().astype(np.int64), case.lattice.model.states()
    low, high = (0, len(names) - 1) if names else (-(2**30), 2**30)
    wrong = np.flatnonzero((flat < low) | (flat > high))
    if len(wrong):
        raise CaseError(
            f"{key}: site {int(wrong[0])} has state {int(flat[wrong[0]])}: expected {low} to {high}"
        )
    return flat.astype(kind_of(case))


def first_state(case: Case, arrays: Mapping[str, Any]) -> States:
    """The states (n,) to start from: those of an array, or of the case."""
    if "states" in arrays:
        return checked(case, "states", arrays["states"])
    return case.lattice.first().states(case)


def files_of(case: Case) -> dict[str, Path]:
    """The file or folder that a case starts from."""
    start = case.lattice.start
    found = {key: getattr(start, key, None) for key in ("file", "run")}
    return {f"lattice.start.{key}": Path(name) for key, name in found.items() if name is not None}


def _number(case: Case, key: str, name: str | None, usual: int) -> int:
    names: Sequence[str] = case.lattice.model.states()
    if name is None:
        return usual if len(names) != 1 else 0
    if not names:
        raise CaseError(f"lattice.start.{key} = {show(name)}: heights have no names; leave it out")
    if name not in names:
        raise CaseError(
            f"lattice.start.{key} = {show(name)}: expected {one_of(names)}{nearest(name, names)}"
        )
    return names.index(name)
