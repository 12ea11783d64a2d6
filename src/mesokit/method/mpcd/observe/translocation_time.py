"""Times that chains take through a plane, from the first bead to the last."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.compression import unit_cell
from mesokit.method.mpcd.expected.ideal import flow_axis, flow_sign
from mesokit.method.mpcd.expected.selection import KIND, molecule_of
from mesokit.method.mpcd.observe.shared.events import EventAccumulator, crossing, require_still
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result


@component
class TranslocationTime(Observable):
    """Times from when the first bead of a molecule passes a plane until the last one is through.

    The plane lies across the axis at a position, such as the middle of a contraction, and again in
    each image of the box (or after each unit cell of an array). A molecule that draws back
    entirely before its last bead is through has failed, and begins anew.
    """

    quantity: Literal["translocation-time"] = tag("translocation-time")
    needs_fluid: ClassVar[bool] = False
    axis: Axis | None = param(
        None, doc="the way (along the force on the fluid, x unless there is one)"
    )
    position: float = param(0.0, doc="of the plane along the axis", unit="a")
    length: float | None = param(
        None,
        doc="from plane to plane (the unit cell of an array, else the box, unless said)",
        unit="a",
        gt=0,
    )
    kind: int | str = param(1, doc=KIND)
    molecules: int = param(2000, doc="those followed, evenly spread over all", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules, and for an axis along which images slide."""
        molecule_of(case, self.quantity, self.kind)
        axis = flow_axis(case, self.axis)
        require_still(case, axis, "axis")
        if not 0 <= self.position <= case.box.size[axis]:
            raise CaseError(
                f"position = {self.position:g}: outside the box; expected 0 to "
                f"{case.box.size[axis]:g}, its length along {AXES[axis]}"
            )


@accumulator_of(TranslocationTime)
class TranslocationTimeAccumulator(EventAccumulator):
    """Places of the first and last bead of each molecule, and since when it is in a plane.

    Memory: `time`, `front`, `back`, `plane` (the next to be passed by the last bead), `behind`
    (whether all beads are behind it), `since` (when the first bead passed it; nan if unknown),
    and `failed`, the number of those that drew back.
    """

    lasting, events = "translocation time", "translocations"

    def prepare(self) -> None:
        super().prepare()
        observable, case = self.observable, self.case
        self.axis = flow_axis(case, observable.axis)
        self.sign = flow_sign(case, self.axis)
        self.position = self.sign * observable.position
        self.length = observable.length or unit_cell(case, self.axis)
        self.failed = 0  # in pooled runs

    def observe(self, fluid: RunningFluid) -> None:
        x = self.sign * self.each(fluid)[:, :, self.axis] - self.position
        front, back, time = x.max(axis=1), x.min(axis=1), float(fluid.time)
        self.samples_here += 1
        self.durations.look(time)
        if not self.now:
            plane = np.floor(back / self.length) + 1
            self.now = {
                "plane": plane,
                "behind": front < plane * self.length,
                "since": np.full(len(x), np.nan),
                "failed": np.zeros(1, np.int64),
            }
        else:
            times = float(self.now["time"]), time
            while self.move(front, back, times):
                pass
        self.now |= {"time": np.array(time), "front": front, "back": back}

    def move(self, front: Array, back: Array, times: tuple[float, float]) -> bool:
        """Bring each molecule a stage further; whether there may be another."""
        now, length = self.now, self.length
        place = now["plane"] * length
        entered = now["behind"] & (front >= place)
        when = crossing(now["front"], front, place, times)
        # where the first bead was beyond the plane before, its passage was not seen
        now["since"][entered] = np.where(now["front"] < place, when, np.nan)[entered]
        now["behind"][entered] = False
        drew_back = ~now["behind"] & (front < place)
        now["failed"] += int((drew_back & np.isfinite(now["since"])).sum())
        now["behind"][drew_back] = True
        through = ~now["behind"] & (back >= place)
        end = crossing(now["back"], back, place, times)
        done = through & np.isfinite(now["since"])
        self.durations.add(end[done], (end - now["since"])[done], np.flatnonzero(done))
        now["plane"][through] += 1
        now["behind"][through] = True  # until its first bead is found beyond the next plane
        returned = now["behind"] & (front < place - length)
        now["plane"][returned] -= 1
        return bool(through.any() or returned.any())

    def pool(self, other: EventAccumulator) -> None:
        assert isinstance(other, TranslocationTimeAccumulator)
        super().pool(other)
        self.failed += other.in_vain

    @property
    def in_vain(self) -> int:
        return self.failed + int(self.now["failed"][0] if self.now else 0)

    def result(self) -> Result:
        return self.made(self.comparisons())

    def comparisons(self) -> Iterator[Comparison]:
        value, error = self.durations.mean()
        yield Comparison("mean translocation time", value, error, unit="tau", note=self.note())
        yield self.counted()
        tries = self.durations.number + self.in_vain
        if tries:
            share = self.durations.number / tries
            scatter = (share * (1 - share) / tries) ** 0.5 if tries > 1 else np.nan
            yield Comparison("share of tries that go through", share, scatter)
