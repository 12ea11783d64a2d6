"""Events of molecules: how long they lasted, in bounded memory, and the base of what times them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.selection import group_of
from mesokit.observe.shared.origins import GROUPS
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Array, Estimate, of_ratio
from mesokit.seam.observable import BlockAccumulator, State, pack, unpack
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import student

FEW = 5.0  # events of each molecule: with fewer the mean misses those that take long
MOST = 2**16  # events kept; every other one is dropped when they are full
PARTS = 64  # equal parts of the time of a run, for error bars
FEWEST, MANY = 8, 40  # bins of a histogram
ALIKE, ONE = 1e-3, 0.1  # of the longest: spread of equal durations; width of their one bin


class Histogram(NamedTuple):
    """Probability density (bins,) between edges (bins + 1,), and its standard error."""

    edges: Array
    density: Array
    error: Array


class Events(NamedTuple):
    """Events of one run; times in tau.

    ends, lasted: when each event ended, and how long it lasted (events,).
    whole: False if it had begun before the run; ids: number of its molecule (events,).
    span: first and last time of the run (2,).
    number: of all whole events, those that were thinned out too.
    """

    ends: Array
    lasted: Array
    whole: NDArray[np.bool_]
    ids: NDArray[np.int64]
    span: Array
    number: int


class Durations:
    """Events that end at a time and have lasted for so long.

    Events that had begun before the run are stored in `runs`, and left out of means.

    Error bars come from sums over `PARTS` equal parts of the time. So events that follow from one
    another, or happen to all molecules at once, do not count as independent.

    >>> events = Durations()
    >>> for time in range(64):
    ...     events.look(time)
    ...     events.add(time, np.array([1.0, 3.0]), ids=np.arange(2))
    >>> events.number, [round(x, 9) for x in events.mean()]
    (128, [2.0, 0.0])
    """

    def __init__(self) -> None:
        self._rows = np.zeros((MOST, 4))  # end, duration, 1 if it is whole, whose
        self._counts = np.array([0, 1, 0, 0])  # rows kept, events per row, events, whole ones
        self._span = np.full(2, np.nan)  # first and last time that was looked at
        self._others: list[Events] = []  # of pooled runs

    def look(self, time: float) -> None:
        """Note that all events up to a time are there."""
        if np.isnan(self._span[0]):
            self._span[0] = time
        self._span[1] = time

    def add(self, ends: Any, lasted: Array, ids: NDArray[Any], whole: Any = True) -> None:
        """Take in events, in the order of their ends but for those of one sample."""
        # Every stride-th event is kept. In a full memory every other one is dropped, and the stride
        # doubled, so that kept events are evenly spaced.
        for row in np.stack(np.broadcast_arrays(ends, lasted, whole, ids), axis=1).astype(float):
            kept, stride, number, complete = self._counts
            if number % stride == 0 and kept == MOST:
                self._rows[: MOST // 2] = self._rows[::2]
                kept, stride = MOST // 2, 2 * stride
            if number % stride == 0:
                self._rows[kept] = row
                kept += 1
            self._counts[:] = kept, stride, number + 1, complete + row[2]

    def state(self) -> State:
        kept = self._counts[0]
        return pack(rows=self._rows[:kept], counts=self._counts, span=self._span)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        self._rows[: len(state["rows"])] = state["rows"]
        self._counts, self._span = np.array(state["counts"]), np.array(state["span"])

    def pool(self, other: Durations) -> None:
        self._others += other.runs

    @property
    def runs(self) -> list[Events]:
        """The events of each run."""
        ends, lasted, whole, ids = self._rows[: self._counts[0]].T
        own = Events(
            ends, lasted, whole > 0, ids.astype(np.int64), self._span, int(self._counts[3])
        )
        return [own, *self._others]

    @property
    def number(self) -> int:
        """Number of whole events, stored or thinned out."""
        return sum(run.number for run in self.runs)

    @property
    def lasted(self) -> Array:
        return np.concatenate([run.lasted[run.whole] for run in self.runs])

    def sums(self, values: Array) -> Array:
        """Sums (parts, n) of values (events, n) over the whole events in each part of the time."""
        ends = [run.ends[run.whole] for run in self.runs]
        numbers = np.split(values, np.cumsum([len(end) for end in ends])[:-1])
        runs = zip(self.runs, ends, numbers, strict=True)
        return np.concatenate([in_parts(run.span, end, n) for run, end, n in runs])

    def by_molecule(self, values: Array, molecules: Sequence[int]) -> Array:
        """Sums (groups, n) of values (events, n) over the whole events of each group of molecules.

        `molecules`: number of molecules in each run.
        """
        groups = np.minimum(GROUPS, molecules)
        firsts = np.cumsum(groups) - groups
        runs = zip(self.runs, groups, firsts, strict=True)
        sums = np.zeros((groups.sum(), values.shape[1]))
        np.add.at(
            sums, np.concatenate([r.ids[r.whole] % n + first for r, n, first in runs]), values
        )
        return sums

    def mean(self) -> tuple[float, float]:
        """Mean duration and its standard error; nan without events, the error with too few."""
        if not len(self.lasted):
            return np.nan, np.nan
        sums = self.sums(np.stack([self.lasted, np.ones(len(self.lasted))], axis=1))
        return ratio(sums)

    def histogram(self) -> Histogram:
        """The distribution, in 8 to 40 bins from the shortest to the longest.

        One event, or those that all last for as long, are a single bin about that time.
        """
        lasted = self.lasted
        if not len(lasted):
            return Histogram(np.zeros(1), np.zeros(0), np.zeros(0))
        bins = int(np.clip(3 * len(lasted) ** (1 / 3), FEWEST, MANY))
        least, most = float(lasted.min()), float(lasted.max())
        margin = (most - least) / (2 * bins)
        if most - least <= ALIKE * most:
            bins, margin = 1, ONE / 2 * most or 0.5
        edges = np.linspace(max(least - margin, 0.0), most + margin, bins + 1)
        place = np.clip(np.searchsorted(edges, lasted, side="right") - 1, 0, bins - 1)
        within = (place[:, None] == np.arange(bins)).astype(float)
        number = self.sums(np.ones((len(lasted), 1)))
        found = of_ratio(self.sums(within), np.broadcast_to(number, (len(number), bins)))
        width = edges[1] - edges[0]
        return Histogram(edges, found.value / width, found.error / width)


def in_parts(span: Array, ends: Array, values: Array) -> Array:
    """Sums (parts, n) of values (events, n) over the events that end in each part of a run."""
    edges = np.linspace(float(span[0]), float(span[1]), PARTS + 1)[1:-1]
    sums = np.zeros((PARTS, values.shape[1]))
    np.add.at(sums, np.searchsorted(edges, ends, side="right"), values)
    return sums


def sum_error(parts: Array) -> float:
    """Standard error of the sum of independent parts (n,) that are alike.

    >>> round(sum_error(np.array([1.0, 3.0] * 8)), 2)  # 4 of a scatter of 1, by Student's factor
    4.27
    """
    if len(parts) < 2:
        return np.nan
    return float(student(len(parts)) * parts.std(ddof=1) * np.sqrt(len(parts)))


def ratio(sums: Array) -> tuple[float, float]:
    """Ratio of the first to the second of two sums (parts, 2), and its standard error.

    Events that end early in a run are short; their bias falls with later parts of the time.
    """
    found: Estimate = of_ratio(sums[:, 0], sums[:, 1])._replace(falling=True)
    return float(found.value), float(found.error)


class EventAccumulator(BlockAccumulator):
    """Followed molecules, their numbers from sample to sample, and the events that they had.

    `now` holds an array for each number that the next sample needs; none before the first one.
    """

    memory: ClassVar[tuple[str, ...]] = ("durations",)
    lasting: ClassVar[str]  # what lasts, such as "residence time"
    events: ClassVar[str]  # in the plural

    def prepare(self) -> None:
        observable, self.kind = self.observable, self.observable.kind
        self.group = group_of(self.case, self.of, self.kind)
        self.beads = self.group.beads(observable.molecules)
        self.everything = self.beads.size == self.case.particles and self.case.solutes is None
        self.durations, self.now = Durations(), dict[str, NDArray[Any]]()
        self.samples_here = 0
        self.others: list[tuple[int, int]] = []  # molecules and samples of pooled runs

    @property
    def of(self) -> str:
        """The kind of group that is followed."""
        return "centres"

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
        events = self.events if number != 1 else self.events.removesuffix("s")
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
        return self.report(
            {"duration": (edges[1:] + edges[:-1]) / 2},
            (density, error),
            comparisons,
            drawing="histogram",
            label="probability density",
            units={"value": "1/tau", "duration": "tau"},
            expected=wanted,
            theory=theory,
            samples=self.samples,
            extra={
                "edges": edges,
                "of": self.lasting,
                "mean": mean,
                "mean_error": mean_error,
                "durations": self.durations.lasted,
            },
        )

    def counted(self) -> Comparison:
        return Comparison(self.events, self.durations.number, np.nan)


def require_still(case: Case, axis: int, key: str) -> None:
    """Raise CaseError for an axis along which images of the box slide."""
    if case.box.sheared and axis == 0:
        raise CaseError(f"{key}: not 'x' under shear, whose images slide")


def crossing(before: Array, after: Array, place: Array, times: tuple[float, float]) -> Array:
    """Times at which straight paths between two times cross a place."""
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (place - before) / (after - before)
    return np.asarray(times[0] + share * (times[1] - times[0]))
