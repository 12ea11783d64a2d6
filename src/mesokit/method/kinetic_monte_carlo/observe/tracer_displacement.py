"""Displacement of particles that hop from site to site, and how fast they drift."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal, Self

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, name_of, param, show, tag
from mesokit.case.describe.digits import two_digits
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.expected_records import Tracers, behind, exchanges
from mesokit.method.kinetic_monte_carlo.observe.protocol import LatticeObservable, RunningLattice
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import state_number
from mesokit.observe.mean_square_displacement import Slope, late_slope
from mesokit.observe.shared.fitted import fitted_number
from mesokit.observe.shared.origins import GROUPS, Origins
from mesokit.seam.estimate import Estimate, of_ratio
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined
from mesokit.statistics import Blocks, spread_ids

SHORTEST = 3  # sites along a periodic axis on which a hop has one direction
DRIFTS = 4.0  # standard errors beyond which particles drift


@component
class TracerDisplacement(LatticeObservable):
    """Mean square displacement of the particles that were in a state when measuring began.

    Particles keep their numbers while they hop; two neighbours that exchange their states exchange
    their places. A particle that leaves the lattice, or whose state turns to another, counts as
    long as it is there. Lags are about equally spaced in log.
    """

    quantity: Literal["tracer-displacement"] = tag("tracer-displacement")
    drawing, value_label = "displacement", "mean square displacement"
    units: ClassVar[dict[str, str]] = {"value": "a^2", "time": "tau"}
    measures: ClassVar[tuple[str, ...]] = ("tracers",)
    state: str | None = param(None, doc="name of the state (the second unless said)")
    particles: int = param(2000, doc="particles followed at most, evenly spread", ge=1)
    max_lag: int = param(1000, doc="longest lag", unit="steps", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError for heights, a state that is none, and hops without a direction."""
        super().check(case)
        if not case.lattice.model.states():
            raise CaseError(
                f"model {show(name_of(case.lattice.model))} has heights, whose atoms have no "
                "numbers; expected a model with named states"
            )
        state = 1 if self.state is None else state_number(case, self.state)
        if not exchanges(case, state):
            raise CaseError(
                f"model {show(name_of(case.lattice.model))}: nothing moves "
                f"{show(case.lattice.model.states()[state])} to a neighbour; leave it out"
            )
        for axis, length in zip(case.box.axes, case.box.size, strict=True):
            if length < SHORTEST and axis not in case.lattice.ends:
                raise CaseError(
                    f"box.size = {show(list(case.box.size))}: expected at least {SHORTEST} sites "
                    f"along {axis}, where the lattice is periodic"
                )


@accumulator_of(TracerDisplacement)
class TracerAccumulator(BlockAccumulator):
    """Displacements of the particles at many origins, and which of them are there."""

    memory: ClassVar[tuple[str, ...]] = (
        "ids",
        "before",
        "moved",
        "there",
        "blocks",
        "followed",
    )
    added: ClassVar[tuple[str, ...]] = ("followed",)
    observable: TracerDisplacement

    def prepare(self) -> None:
        self.axes, made = len(self.case.box.size), self.observable
        self.wanted = 1 if made.state is None else state_number(self.case, made.state)
        self.max_lag = max(1, made.max_lag // made.every)
        self.interval = made.every * self.case.lattice.timestep
        # all that follows is made at the first sample, when the number of particles is known
        self.ids = np.zeros(0, np.int64)
        self.before = np.zeros((0, self.axes))
        self.moved: Origins | None = None
        self.there: Origins | None = None
        self.blocks = Blocks(self.axes + 1)  # sums of displacements, and of particles times time
        # particles followed, and those that are left; the first times the particles in the state,
        # and times the sites not in the state behind
        self.followed = np.zeros(4)

    def _follow(self, ids: NDArray[np.int64]) -> None:
        self.ids, self.before = ids, np.zeros((len(ids), self.axes))
        self.moved = Origins(len(ids), self.axes + 1, self.max_lag)
        self.there = Origins(len(ids), 1, self.max_lag)

    def observe(self, engine: RunningLattice) -> None:
        if not self.blocks.count:
            began = engine.began()
            every = np.flatnonzero(began == self.wanted)
            ids = _by_region(every[spread_ids(self.observable.particles, len(every))])
            others = np.count_nonzero(began != behind(self.wanted))
            self.followed = len(ids) * np.array([1.0, 1.0, len(every), others])
            if len(ids):
                self._follow(ids)
                self._add(self.before, np.ones(len(ids), bool))
        place, kept = engine.tracers(self.ids)
        steps = (place - self.before)[kept].sum(axis=0)
        self.blocks.add([*steps, kept.sum() * self.interval])
        self.before, self.followed[1] = place, kept.sum()
        if len(self.ids):
            self._add(place, kept)

    def _add(self, place: Array, kept: NDArray[np.bool_]) -> None:
        if self.moved is not None and self.there is not None:
            self.moved.add(np.column_stack([place, kept]), _square_if_there)
            self.there.add(kept[:, None].astype(float), _still_there)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        if len(state["ids"]):
            self._follow(np.array(state["ids"]))
        super().restore(state)

    def pool(self, other: Self) -> None:
        """Take in the particles of another run, if there are any."""
        for name in ("moved", "there"):
            mine, theirs = getattr(self, name), getattr(other, name)
            if mine is None:
                setattr(self, name, theirs)
            elif theirs is not None:
                mine.pool(theirs)
        self.blocks.pool(other.blocks)
        self.followed = self.followed + other.followed

    def result(self) -> Result:
        """The curve, its slope where it is a straight line, and the drift."""
        if self.moved is None or self.there is None:
            nothing = np.zeros(0)
            return self.report({"time": nothing}, (nothing, nothing), extra=self._components())
        time = self.moved.sampled() * self.interval
        square, seen = _mean_of_those_there(self.moved.estimate(), self.there.estimate())
        # numbers when measuring began, the mean over runs by those followed
        numbers = self.followed[2:] / self.followed[0]
        time, known = time[seen], Tracers(self.case, self.wanted, *numbers)
        expected, note = known.displacement(time)
        sums, _ = self.blocks.sums()
        drift = of_ratio(sums[:, :-1], np.repeat(sums[:, -1:], self.axes, axis=1))
        moving = known.drifts or bool((abs(drift.value) > DRIFTS * drift.error).any())
        slope = None if known.ring or moving else late_slope(time, square, 0.0)
        return self.report(
            {"time": time},
            square,
            [
                *self._diffusion(slope, known, moving),
                *self._last(square, expected, known, note),
                *self._drift(drift, known),
            ],
            expected=expected,
            theory=note,
            fit=None if slope is None else slope.line,
            extra=self._components(),
        )

    def _components(self) -> dict[str, str]:
        return {"components": "xyz"[: self.axes]}

    def _left(self) -> str:
        gone = 1 - self.followed[1] / self.followed[0]
        return f"{two_digits(100 * gone)} % of the particles have left" if gone else ""

    def _diffusion(self, slope: Slope | None, known: Tracers, moving: bool) -> Iterator[Comparison]:
        what, unit = "diffusion coefficient", "a^2/tau"
        expected, note = known.diffusion()
        if known.ring or moving:
            why = "particles drift" if moving else "particles in a single file do not diffuse"
            yield Comparison(what, math.nan, math.nan, math.nan, unit, why)
        elif slope is not None:
            scale = 1 / (2 * self.axes)
            bends = "" if slope.straight else "approximate: no straight line yet, a larger max_lag"
            note = joined(bends, note.removeprefix("approximate: ") if bends else note)
            yield fitted_number(
                what,
                slope.value * scale,
                slope.error * scale,
                expected,
                unit,
                joined(note, self._left()),
            )

    def _last(
        self, square: Estimate, expected: Array | None, known: Tracers, note: str
    ) -> Iterator[Comparison]:
        if known.ring and not known.drifts and expected is not None:
            what = "mean square displacement at the longest lag"
            ends = square.value[-1], square.error[-1], expected[-1]
            yield Comparison(what, *ends, "a^2", f"approximate: {note}")

    def _drift(self, drift: Estimate, known: Tracers) -> Iterator[Comparison]:
        expected, note = known.drift()
        for axis in range(self.axes):
            yield Comparison(
                f"drift along {'xyz'[axis]}",
                drift.value[axis],
                drift.error[axis],
                expected[axis],
                "a/tau",
                joined(note, self._left()),
            )


def _by_region(ids: NDArray[np.int64]) -> NDArray[np.int64]:
    """Particles in an order in which each group of `Origins` is of one region: those that are near
    hinder one another, and are not independent."""
    groups = min(GROUPS, len(ids))
    return (
        ids[: len(ids) // max(groups, 1) * groups].reshape(groups, -1).T.ravel() if groups else ids
    )


def _square_if_there(old: Array, new: Array) -> Array:
    """Square displacements, 0 of particles that have left; the last column is whether they are
    there."""
    step = new[:, :-1] - old[:, :-1]
    return np.einsum("ij,ij->i", step, step) * new[:, -1]


def _still_there(old: Array, new: Array) -> Array:
    return new[:, 0]


def _mean_of_those_there(above: Estimate, below: Estimate) -> tuple[Estimate, NDArray[np.bool_]]:
    """Mean over the particles that are there at the end of a lag, of lags that any has reached."""
    seen = below.value > 0
    total = below.value[seen]
    value = above.value[seen] / total

    def part(one: Estimate, other: Estimate, within: Estimate | None) -> Estimate:
        residuals = (one.residuals[:, seen] - value * other.residuals[:, seen]) / total
        spans = None if one.spans is None else one.spans[seen]
        return Estimate(value, residuals, one.weights[:, seen], in_time=within, spans=spans)

    both = above.in_time, below.in_time
    in_time = None if both[0] is None or both[1] is None else part(both[0], both[1], None)
    return part(above, below, in_time), seen
