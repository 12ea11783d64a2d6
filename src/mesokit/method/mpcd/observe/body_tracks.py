"""Bodies in time: place, direction, velocity, angular velocity, force and torque of each."""

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected.bodies import KIND_OF_BODY, followed
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import TimeSeries, spread_ids

NUMBERS = 2**20  # of the time series, for all bodies together
MOST_ROWS = 4096
UNITS = {
    "": "a", "heading ": "", "angle": "", "v": "a/tau", "spin": "1/tau", "force ": "m a/tau^2",
    "torque": "m a^2/tau^2",
}  # fmt: skip


@component
class BodyTracks(Observable):
    """Place, direction of axis x, angle, velocity, angular velocity, force and torque of bodies.

    Each body has its own series: `result.x["time"]` by `body` by `component`. Places are unwrapped:
    they grow as a body goes from box to box (under shear nan along x, where images slide). Angles
    are angular velocities summed over time, in radians. Forces and torques are those of all that
    acts, in the last timestep. In 2D angles, angular velocities and torques are about z.
    """

    quantity: Literal["body-tracks"] = tag("body-tracks")
    drawing = "body tracks"
    value_label = "bodies in time"
    kind: int | str = param(1, doc=KIND_OF_BODY)
    bodies: int = param(20, doc="bodies followed, evenly spread over all", ge=1, le=10_000)

    def check(self, case: Case) -> None:
        """Raise CaseError without such bodies."""
        followed(case, self.quantity, self.kind)

    def warnings(self, case: Case) -> Iterator[str]:
        kept = BodyTracksAccumulator(self, case)
        samples = case.run.steps // self.every + 1
        if samples > kept.rows:
            yield (
                f"every = {self.every}: {samples} samples of {len(kept.ids)} bodies are more than "
                f"are kept; each row of the series will be the mean of up to "
                f"{2 ** int(np.ceil(np.log2(samples / kept.rows)))} samples"
            )


@accumulator_of(BodyTracks)
class BodyTracksAccumulator(BlockAccumulator):
    """A series of every body."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples")
    added: ClassVar[tuple[str, ...]] = ("samples",)

    def prepare(self) -> None:
        observable, self.dimension, self.samples = self.observable, self.case.box.dimension, 0
        self.of = followed(self.case, observable.quantity, observable.kind)
        self.ids = self.of.rows.start + spread_ids(observable.bodies, self.of.number)
        width = len(self.ids) * len(self.components)
        self.rows = min(MOST_ROWS, 2 * max(NUMBERS // width // 2, 1))
        self.series = TimeSeries(width, self.rows)

    @property
    def components(self) -> dict[str, str]:
        """Names of the components and their units."""
        found: dict[str, str] = {}
        for name, unit in UNITS.items():
            about_z = self.dimension == 2 and name in ("angle", "spin", "torque")
            apart = " " if name in ("angle", "spin", "torque") else ""
            axes = [""] if about_z else [apart + axis for axis in AXES[: self.dimension]]
            found |= {f"{name}{axis}": unit for axis in axes}
        return found

    def observe(self, fluid: Any) -> None:
        bodies = fluid.bodies
        place = bodies.places(unwrapped=True)
        if self.case.box.sheared:
            place[:, 0] = np.nan
        turning = slice(2, 3) if self.dimension == 2 else slice(3)
        columns = [
            place, bodies.headings, bodies.angles[:, turning], bodies.velocities,
            bodies.spins[:, turning], bodies.forces, bodies.torques[:, turning],
        ]  # fmt: skip
        self.series.add(fluid.time, np.concatenate(columns, axis=1)[self.ids].ravel())
        self.samples += 1

    def result(self) -> Result:
        units = self.components
        value = self.series.values().reshape(-1, len(self.ids), len(units))
        return self.report(
            {
                "time": self.series.time(),
                "body": 1 + self.ids - self.of.rows.start,
                "component": list(units),
            },
            value,
            units={"value": "", "time": "tau", "body": ""} | units,
            samples=self.samples,
            extra={"samples_per_row": self.series.stride, "name": self.of.name},
        )
