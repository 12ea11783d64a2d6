"""Times that molecules stay in a region, or near a solid."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.geometry.shape.plates import Plates
from mesokit.geometry.solids.solids import Solids, labels
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.ideal import drift_of
from mesokit.method.mpcd.expected.selection import KIND, group_of
from mesokit.method.mpcd.observe.shared.events import EventAccumulator, in_parts, ratio
from mesokit.observe.shared.origins import GROUPS
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result

FEWEST = 8  # molecules that tell how far times differ from one to another


@component
class ResidenceTime(Observable):
    """Times that molecules stay in a region, from when they come in until they are out again.

    Seen at the samples: a molecule that is out and in again between two of them has stayed. One
    that has just come in is soon out again, the more often the more frequent samples are; the mean
    time until exit, from any moment in the region, does not depend on that.
    """

    quantity: Literal["residence-time"] = tag("residence-time")
    needs_fluid: ClassVar[bool] = False
    region: Either[None, tuple[float, float]] = param(
        None,
        doc="[from, to] along each axis; beyond the box it goes on at its other end (unless said, "
        "what is near a solid)",
        unit="a",
    )
    near: float = param(
        2.0, doc="without a region: no farther than this from a solid's surface", unit="a", gt=0
    )
    solid: str | None = param(
        None, doc="name of the wall to be near (any; plates where nothing else is)", min_length=1
    )
    of: Literal["centres", "beads"] = param(
        "centres", doc='what must be there: the centre of mass, or any of the "beads"'
    )
    kind: int | str = param(1, doc=KIND)
    molecules: int = param(2000, doc="those followed, evenly spread over all", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules, and for a region that cannot be."""
        group_of(case, "centres", self.kind)
        if case.box.sheared:
            raise CaseError("residence-time: not under shear, whose images slide")
        if self.region is None:
            self.solids(case)
            return
        if self.solid is not None:
            raise CaseError("solid: no effect with a region; leave one of them out")
        if len(self.region) != case.box.dimension:
            raise CaseError(
                f"region = {show(self.region)}: expected [from, to] along each of the "
                f"{case.box.dimension} axes"
            )
        for (low, high), length in zip(self.region, case.box.size, strict=True):
            if not 0 < high - low <= length:
                raise CaseError(
                    f"region = {show(self.region)}: expected from < to, no more than the box "
                    f"({length:g}) apart; not [{low:g}, {high:g}]"
                )
            if high <= 0 or low >= length:
                raise CaseError(
                    f"region = {show(self.region)}: [{low:g}, {high:g}] lies outside the box; "
                    f"expected a part between 0 and {length:g}"
                )

    def solids(self, case: Case) -> Solids:
        """Those to be near. Raises CaseError where there is none."""
        names = labels(case.walls)
        if not names:
            raise CaseError("region: missing; there is no solid to be near either")
        if self.solid is None:
            others = [i for i, wall in enumerate(case.walls) if not isinstance(wall, Plates)]
            return Solids(case.walls, case.box, only=others or None)
        if self.solid not in names:
            raise CaseError(f"solid = {self.solid!r}: expected one of {', '.join(names)}")
        return Solids(case.walls, case.box, only=[names.index(self.solid)])


@accumulator_of(ResidenceTime)
class ResidenceTimeAccumulator(EventAccumulator):
    """Molecules that are inside, and since when.

    Memory: `inside`, `since` (the first sample where that was before it), `whole` (whether it was
    not).
    """

    memory: ClassVar[tuple[str, ...]] = ("durations", "share")
    added: ClassVar[tuple[str, ...]] = ("runs",)

    lasting, events = "residence time", "visits"

    def prepare(self) -> None:
        super().prepare()
        observable, case = self.observable, self.case
        self.region, self.near = observable.region, observable.near
        self.size = np.array(case.box.size, float)
        if self.region is None:
            self.look = observable.solids(case).depths(self.near)
        self.interval = observable.every * case.fluid.timestep
        self.share = MeansOverMolecules(len(self.beads), 1)
        self.runs: list[ResidenceTimeAccumulator] = [self]  # those that are pooled

    def observe(self, fluid: RunningFluid) -> None:
        inside, time, now = self.within(self.each(fluid)), float(fluid.time), self.now
        self.samples_here += 1
        self.durations.look(time)
        self.share.add(inside[:, None].astype(float))
        if not now:
            since = np.full(len(inside), time)
            self.now = {"inside": inside, "since": since, "whole": np.zeros(len(inside), bool)}
            return
        left = now["inside"] & ~inside
        lasted = time - now["since"][left]
        self.durations.add(time, lasted, np.flatnonzero(left), now["whole"][left])
        entered = inside & ~now["inside"]
        now["since"][entered] = time
        now["whole"] |= entered
        now["inside"] = inside

    def within(self, beads: Array) -> NDArray[np.bool_]:
        """Which molecules (molecules,) are there."""
        places = beads.mean(axis=1, keepdims=True) if self.observable.of == "centres" else beads
        if self.region is not None:
            low, high = np.array(self.region, float).T
            there = ((places - low) % self.size < high - low).all(axis=2)
        else:
            body, distance, _ = self.look((places % self.size).reshape(-1, len(self.size)))
            there = ((body >= 0) & (distance <= self.near)).reshape(places.shape[:2])
        return np.asarray(there.any(axis=1))

    def result(self) -> Result:
        return self.made(self.comparisons())

    def comparisons(self) -> Iterator[Comparison]:
        few = self.note()
        value, error = self.durations.mean()
        note = few or "of a visit; the more often one looks, the shorter they are"
        yield Comparison("mean residence time", value, error, unit="tau", note=note)
        value, error = self.exit_time()
        expected, of_theory = self.until_exit()
        if self.visit_is_long():
            expected, of_theory = np.nan, "lower bound: of visits as long as half the run"
        yield Comparison("mean time until exit", value, error, expected, "tau", of_theory)
        yield self.counted()
        inside, note = self.share.total(), self.share.caution()
        yield Comparison("share of the time inside", *inside, self.volume(), note=note)

    def exit_time(self) -> tuple[float, float]:
        """Mean time from any sample inside to the first one outside, and its standard error.

        It is the sum over lags of the share that is still inside, of those that were inside a lag
        before the end of the run or earlier. So visits count that the ends of the run have cut,
        and a short run does not make it short.
        """
        if not self.samples:
            return np.nan, np.nan
        return ratio(np.concatenate([run.visited() for run in self.runs]))

    def visit_is_long(self) -> bool:
        """Whether a visit lasted, or lasts, for half of a run or longer."""
        for run in self.runs:
            events, since = run.durations.runs[0], run.now.get("since", np.zeros(0))
            going = events.span[1] - since[run.now["inside"]] if len(since) else since
            longest = np.append(events.lasted, going).max(initial=0.0)
            if longest > 0.5 * (events.span[1] - events.span[0]) > 0:
                return True
        return False

    def visited(self) -> Array:
        """Sums (groups, 2) over the visits of this run: of times until exit, and of samples.

        The groups are of molecules; of few molecules they are parts of the time.
        """
        events, now, samples = self.durations.runs[0], self.now, self.samples_here
        going, end = np.flatnonzero(now["inside"]), events.span[1]
        stay = np.append(events.lasted, end - now["since"][going] + self.interval) / self.interval
        inverse = np.append(0.0, np.cumsum(1 / np.arange(1.0, samples + 1)))
        stay = np.clip(np.rint(stay).astype(int), 1, samples)
        rest = samples - stay
        until = stay - rest * (inverse[samples] - inverse[rest])
        sums = np.stack([self.interval * samples * until, stay], axis=1)
        if len(self.beads) < FEWEST:
            return in_parts(events.span, np.append(events.ends, np.full(len(going), end)), sums)
        found = np.zeros((min(GROUPS, len(self.beads)), 2))
        np.add.at(found, np.append(events.ids, going) * len(found) // len(self.beads), sums)
        return found

    def volume(self) -> float:
        """The region's part of the box, where all places are alike; else nan."""
        if self.region is None or self.case.walls or setting.gathered(self.case):
            return np.nan
        if self.observable.of == "beads" and self.group.length > 1:
            return np.nan
        low, high = np.array(self.region, float).T
        return float(np.prod((high - low) / self.size))

    def until_exit(self) -> tuple[float, str]:
        """Mean time until exit from a slab in which nothing drives, and what to say of it."""
        drift = drift_of(self.case, self.group, self.kind)
        if drift is None or self.region is None or np.isnan(self.volume()):
            return np.nan, ""
        low, high = np.array(self.region, float).T
        bound = np.flatnonzero(high - low < self.size)
        if len(bound) != 1 or drift.velocity[bound].any():
            return np.nan, ""
        width = float((high - low)[bound[0]])
        forgetful = theory.mean_exit_time(width, drift.diffusion, self.interval)
        known = theory.mean_exit_time(width, drift.diffusion, self.interval, drift.memory)
        if known < 1.02 * forgetful:
            return known, drift.note
        return known, f"approximate: velocities are remembered for {drift.memory:.2g} tau"
