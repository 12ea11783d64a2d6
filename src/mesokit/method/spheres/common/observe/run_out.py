"""Run-out of a column of grains that collapses: its length and height in time."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.observe.protocol import OfSpheres, Samples
from mesokit.method.spheres.common.observe.shared.bed_surface import (
    heights_of,
    horizontal,
    main_mass,
)
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import NOT_STEADY, Array, Comparison, Result, joined
from mesokit.statistics.blocking import FEWEST_BLOCKS

USUAL_GAP = 0.25  # of the mean diameter
LATE, STILL = 0.1, 0.01  # of the samples; of the length by which it grows meanwhile and has stopped
LAWS = {"disks": "Staron and Hinch", "slot": "Lube et al.", "cylinder": "Lube et al."}


@component
class RunOut(OfSpheres):
    """Length and height of a column of grains that collapses in gravity, in time.

    The front is the farthest point of the grains that hang together: some roll ahead alone. Length
    and height at the first sample are those of the column.
    """

    quantity: Literal["run-out"] = tag("run-out")
    drawing, value_label = "path", "extent of the column"
    units: ClassVar[dict[str, str]] = {"value": "a", "time": "tau", "of": ""}
    sides: Literal["lower", "upper", "both", "round"] | None = param(
        None,
        doc="where the column stands: at the lower or the upper end of the axis; or free, when it "
        "spreads to 'both' sides, and its length is half of all; or 'round' about its axis in 3D "
        "('lower' with plates along the axis, else 'both', unless said)",
    )
    axis: Axis | None = param(None, doc="axis of the front (the first horizontal one unless said)")
    gap: float | None = param(
        None,
        doc="between the surfaces of grains that hang together, at most (a quarter of the mean "
        "diameter unless said)",
        unit="a",
        gt=0,
    )

    def check(self, case: Case) -> None:
        """Raise CaseError without gravity along one axis, or room for what is round."""
        _, along = horizontal(case, self.axis, "run-out")
        if self.sides == "round" and case.box.dimension == 2:
            raise CaseError(f"sides = {show(self.sides)}: expected a box of three axes")
        if self.sides == "round" and self.axis is not None:
            raise CaseError(f"axis = {show(self.axis)}: no effect with sides = 'round'")
        if self.sides in ("lower", "upper") and along not in closed_axes(case):
            letter = case.box.axes[along]
            raise CaseError(
                f"sides = {show(self.sides)}: expected plates along {letter}, or sides = 'both'"
            )

    def spreads(self, case: Case) -> str:
        """The sides to which the column spreads."""
        _, along = horizontal(case, self.axis, "run-out")
        return self.sides or ("lower" if along in closed_axes(case) else "both")


@accumulator_of(RunOut)
class RunOutAccumulator(Samples):
    """Length and height in time; `start` are both at the first sample, `middle` the axis of a round
    column then."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples", "start", "middle")
    width = 2

    def prepare(self) -> None:
        super().prepare()
        case = self.case
        self.pull, self.along = horizontal(case, self.observable.axis, "run-out")
        self.sides = self.observable.spreads(case)
        closed, size = closed_axes(case), np.array(case.box.size, float)
        self.period = np.where([k in closed for k in range(len(size))], 0.0, size)
        self.start, self.middle = np.full(2, np.nan), np.full(case.box.dimension, np.nan)

    def observe(self, spheres: RunningSpheres) -> None:
        places, diameters = spheres.positions(unwrapped=True), spheres.diameters()
        given = self.observable.gap
        gap = USUAL_GAP * float(diameters.mean()) if given is None else given
        mass = main_mass(places, diameters, self.period, gap)
        if not self.samples:
            self.middle = places.mean(axis=0)
        height = heights_of(self.case, spheres, self.pull)[mass] + 0.5 * diameters[mass]
        length = self.length(places[mass], 0.5 * diameters[mass])
        now = np.array([length, height.max()])
        if not self.samples:
            self.start = now
        self.series.add(spheres.time, now)
        self.samples += 1

    def length(self, places: Array, radius: Array) -> float:
        """How far grains reach."""
        x, sides = places[:, self.along], self.sides
        if sides == "lower":
            return float((x + radius).max())
        if sides == "upper":
            return float(self.case.box.size[self.along] - (x - radius).min())
        if sides == "both":
            return float(0.5 * ((x + radius).max() - (x - radius).min()))
        others = [k for k in range(3) if k != self.pull]
        away = np.linalg.norm(places[:, others] - self.middle[others], axis=1)
        return float((away + radius).max())

    @property
    def grains(self) -> Literal["disks", "slot", "cylinder"]:
        """What the law was measured of."""
        if self.case.box.dimension == 2:
            return "disks"
        return "cylinder" if self.sides == "round" else "slot"

    def result(self) -> Result:
        """Both in time, and how far the column has run."""
        time, rows = self.series.time(), self.series.values()
        known = np.full(rows.shape, np.nan)
        if len(rows) and self.start[0] > 0:
            known[:, 0] = self.start[0] * (1 + self.law())
        return self.report(
            {"time": time, "of": ["length", "height"]},
            (rows, self.series.error()),
            self.comparisons(rows),
            expected=known if len(rows) else None,
            theory=f"final length, {LAWS[self.grains]}" if len(rows) else "",
            samples=self.samples,
        )

    def law(self) -> float:
        """(L - L_0)/L_0 by the aspect ratio of the column."""
        return float(theory.run_out(self.start[1] / self.start[0], self.grains))

    def comparisons(self, rows: Array) -> Iterator[Comparison]:
        """Aspect ratio, run-out, height, and the time that the column takes."""
        if not len(rows) or not self.start[0] > 0:
            return
        each = self.series.each()[:, -1] / self.start[0]  # (runs, 2)
        value, error = each.mean(axis=0), np.full(2, math.nan)
        if len(each) >= FEWEST_BLOCKS:
            error = each.std(axis=0, ddof=1) / math.sqrt(len(each))
        note = joined(self.spreading(rows), f"approximate: {LAWS[self.grains]}, on a rough floor")
        yield Comparison("aspect ratio of the column", self.start[1] / self.start[0], math.nan)
        yield Comparison(
            "run-out over the first length", value[0] - 1, error[0], self.law(), "", note
        )
        yield Comparison("last height over the first length", value[1], error[1])

    def spreading(self, rows: Array) -> str:
        """A note if the front still moves."""
        before = rows[-max(2, math.ceil(LATE * len(rows))) :, 0]
        if len(before) > 1 and abs(before[-1] - before[0]) > STILL * before[-1]:
            return f"{NOT_STEADY}: the front still moves"
        return ""
