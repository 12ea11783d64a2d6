"""Times that molecules take from one plane across the flow to the next."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected.compression import unit_cell
from mesokit.method.mpcd.expected.ideal import drift_of, flow_axis, flow_sign
from mesokit.method.mpcd.expected.selection import KIND, group_of
from mesokit.method.mpcd.observe.shared.events import (
    EventAccumulator,
    crossing,
    require_still,
    sum_error,
)
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined


@component
class TransitTime(Observable):
    """Times that centres of mass take from plane to plane, a `length` apart, with the flow.

    Planes lie across the axis at all multiples of the length; a transit begins when a molecule is
    at a plane for the first time and ends when it is at the next for the first time. So each way
    counts once, however often a molecule goes back and forth, and the mean is length/velocity.
    """

    quantity: Literal["transit-time"] = tag("transit-time")
    needs_fluid: ClassVar[bool] = False
    axis: Axis | None = param(
        None, doc="the way (along the force on the fluid, x unless there is one)"
    )
    length: float | None = param(
        None,
        doc="from plane to plane (the unit cell of an array, else the box, unless said)",
        unit="a",
        gt=0,
    )
    of: Literal["centres", "particles"] = param(
        "centres", doc='of molecules or monomers; "particles": of the fluid'
    )
    kind: int | str = param(1, doc=KIND)
    molecules: int = param(2000, doc="those followed, evenly spread over all", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules, and for an axis along which images slide."""
        group_of(case, self.of, self.kind)
        require_still(case, flow_axis(case, self.axis), "axis")


@accumulator_of(TransitTime)
class TransitTimeAccumulator(EventAccumulator):
    """Place of each molecule, the next plane that it has not reached, and the time at the last.

    Memory: `time`, `place`, `plane` (number of the next), `since` (nan before the first plane).
    """

    memory: ClassVar[tuple[str, ...]] = ("durations", "velocity")

    lasting, events = "transit time", "transits"

    def prepare(self) -> None:
        super().prepare()
        self.axis = flow_axis(self.case, self.observable.axis)
        self.sign = flow_sign(self.case, self.axis)
        self.length = self.observable.length or unit_cell(self.case, self.axis)
        self.velocity = MeansOverMolecules(len(self.beads), 1, self.everything)

    @property
    def of(self) -> str:
        return str(self.observable.of)

    def observe(self, fluid: RunningFluid) -> None:
        place = self.sign * self.each(fluid)[:, :, self.axis].mean(axis=1)
        time, now = float(fluid.time), self.now
        self.samples_here += 1
        self.durations.look(time)
        if not now:
            plane = np.floor(place / self.length) + 1
            self.now = {"plane": plane, "since": np.full(len(place), np.nan)}
        else:
            times, before = (float(now["time"]), time), now["place"]
            self.velocity.add(((place - before) / (times[1] - times[0]))[:, None])
            while (beyond := place >= now["plane"] * self.length).any():
                self.arrive(np.flatnonzero(beyond), before, place, times)
        self.now |= {"time": np.array(time), "place": place}

    def arrive(
        self, ids: NDArray[np.intp], before: Array, place: Array, times: tuple[float, float]
    ) -> None:
        """Some are beyond their next plane: note when they were at it."""
        plane, since = self.now["plane"], self.now["since"]
        arrived = crossing(before[ids], place[ids], plane[ids] * self.length, times)
        lasted = arrived - since[ids]
        known = np.isfinite(lasted)
        self.durations.add(arrived[known], lasted[known], ids[known])
        since[ids] = arrived
        plane[ids] += 1

    def result(self) -> Result:
        drift = drift_of(self.case, self.group, self.kind)
        speed = self.sign * drift.velocity[self.axis] if drift else 0.0
        if drift is None or not speed > 0:
            return self.made(self.comparisons(0.0, ""))
        diffusion = drift.diffusion
        return self.made(
            self.comparisons(speed, drift.note),
            lambda t: theory.first_passage_cdf(t, self.length, speed, diffusion),
            "drift and diffusion",
        )

    def mean(self) -> tuple[float, float]:
        """Mean time and its standard error, transits that the end of the run has cut included.

        The last, unfinished one is more often a long one. Of n transits one after the other that
        makes the mean short by its variance over n times its square, to the first order in 1/n.
        Where transits are few, that scatters as their number does: blocks of time see the mean
        alone, groups of molecules all of it, and the larger error counts.
        """
        value, error = self.durations.mean()
        lasted = self.durations.lasted
        if not self.durations.number:
            return value, error
        square, each = float((lasted**2).mean()), self.followed / self.durations.number
        more = 1 + lasted.var() / value**2 * each
        powers = np.stack([lasted, lasted**2, np.ones(len(lasted))], axis=1) / len(lasted)
        groups = self.durations.by_molecule(powers, [len(self.beads), *(n for n, _ in self.others)])
        by_mean = 1 - each * (square / value**2 + 1)
        by_number = -value * by_mean - each * (2 * square / value - value)
        scatter = sum_error(groups @ [by_mean, each / value, by_number])
        return value * more, max(error * more, scatter)

    def comparisons(self, speed: float, drift: str) -> Iterator[Comparison]:
        few = self.note()
        wanted = np.nan if few or not speed > 0 else self.length / speed
        yield Comparison("mean transit time", *self.mean(), wanted, "tau", few or drift)
        yield self.counted()
        (value, error), sign = self.velocity.total(), self.sign
        along, note = f"velocity of centres along {AXES[self.axis]}", self.velocity.caution()
        known = sign * speed if speed > 0 else np.nan
        yield Comparison(along, sign * value, error, known, "a/tau", joined(drift, note))
        if value > 3 * error:
            over = self.length / value
            yield Comparison("length over velocity", over, over * error / value, unit="tau")
