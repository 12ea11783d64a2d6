"""Base of observables that time events of molecules: which are followed, and the result."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.selection import group_of
from mesokit.method.mpcd.observe.shared.durations import Durations
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, State, pack, unpack
from mesokit.seam.result import Array, Comparison, Result

FEW = 5.0  # events of each molecule: with fewer the mean misses those that take long


class Words(NamedTuple):
    """What a result is called: quantity, name, what lasts, and what an event is, in the plural."""

    quantity: str
    name: str
    time: str
    events: str


class EventAccumulator(BlockAccumulator):
    """Followed molecules, their numbers from sample to sample, and the events that they had.

    `now` holds an array for each number that must be remembered; none before the first sample.
    """

    memory: ClassVar[tuple[str, ...]] = ("durations",)

    def __init__(self, case: Case, words: Words, of: str, kind: int | str, molecules: int) -> None:
        self.case, self.words, self.name, self.kind = case, words, words.name, kind
        self.group = group_of(case, of, kind)
        self.beads = self.group.beads(molecules)
        self.everything = self.beads.size == case.particles and case.solutes is None
        self.durations, self.now = Durations(), dict[str, NDArray[Any]]()
        self.samples_here = 0
        self.others: list[tuple[int, int]] = []  # molecules and samples of pooled runs

    @property
    def samples(self) -> int:
        """Of all runs."""
        return self.samples_here + sum(samples for _, samples in self.others)

    @property
    def followed(self) -> int:
        """Molecules of all runs."""
        return len(self.beads) + sum(molecules for molecules, _ in self.others)

    def each(self, fluid: RunningFluid) -> Array:
        """Unwrapped positions (molecules, beads, d)."""
        r = fluid.positions(self.beads.ravel(), unwrapped=True)
        return r.reshape(*self.beads.shape, -1)

    def state(self) -> State:
        now = {f"now/{name}": array for name, array in self.now.items()}
        return super().state() | pack(samples=self.samples_here, **now)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        super().restore(state)
        self.samples_here = int(state["samples"])
        self.now = {name: np.array(array) for name, array in unpack(state, "now").items()}

    def pool(self, other: EventAccumulator) -> None:
        super().pool(other)
        self.others += [(len(other.beads), other.samples_here), *other.others]

    def note(self) -> str:
        """Whether so few events have ended that those which take long are missing."""
        if self.durations.number >= FEW * self.followed:
            return ""
        number, molecules = self.durations.number, self.followed
        events = self.words.events if number != 1 else self.words.events.removesuffix("s")
        noun = "molecules" if molecules != 1 else "molecule"
        return f"few: {number} {events} of {molecules} {noun}; long ones may not have ended"

    def made(
        self, comparisons: Iterable[Comparison], expected: Any = None, theory: str = ""
    ) -> Result:
        """The distribution of the durations; `expected` gives its CDF at the edges."""
        edges, density, error = self.durations.histogram()
        mean, mean_error = self.durations.mean()
        wanted = None
        if expected is not None and len(density):
            wanted = np.diff(expected(edges)) / np.diff(edges)
        return Result(
            quantity=self.words.quantity,
            drawing="histogram",
            name=self.name,
            x={"duration": (edges[1:] + edges[:-1]) / 2},
            value=density,
            error=error,
            label="probability density",
            units={"value": "1/tau", "duration": "tau"},
            expected=wanted,
            theory=theory,
            comparisons=tuple(comparisons) if self.samples else (),
            samples=self.samples,
            extra={
                "edges": edges,
                "of": self.words.time,
                "mean": mean,
                "mean_error": mean_error,
                "durations": self.durations.lasted,
            },
        )

    def counted(self) -> Comparison:
        """How many events there were."""
        return Comparison(self.words.events, self.durations.number, np.nan)


def require_still(case: Case, axis: int, key: str) -> None:
    """Raise CaseError for an axis along which images of the box slide."""
    if case.box.sheared and axis == 0:
        raise CaseError(f"{key}: not 'x' under shear, whose images slide")


def crossing(before: Array, after: Array, place: Array, times: tuple[float, float]) -> Array:
    """When straight ways between two times are at a place."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (place - before) / (after - before)
    return np.asarray(times[0] + share * (times[1] - times[0]))
