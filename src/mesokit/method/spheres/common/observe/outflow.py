"""Flow of spheres through a plane: grains, mass and volume per time."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Either
from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.observe.protocol import OfSpheres, pull_axis
from mesokit.method.spheres.common.observe.shared.cut_volumes import whole
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.estimate import Array
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks, TimeSeries

AMOUNTS = ("number", "mass", "volume")
WORDS = {"number": "grains", "mass": "mass", "volume": "volume"}
PIECES, FEWEST = 20, 4  # points of the figure; samples whose scatter is an error bar
USUAL_FRACTION = {2: 0.80, 3: 0.60}  # of a bed, for the law of Beverloo
SHARES = 0.1, 0.9  # of what passes, between which a silo flows


@component
class Outflow(OfSpheres):
    """Grains, mass and volume that pass a plane per time, less those that come back.

    Crossings are seen between two samples, by where centres are: one that crosses and returns
    meanwhile does not count. Along a periodic axis each image of the plane counts. With the `width`
    of an opening the law of Beverloo is beside it.
    """

    quantity: Literal["outflow"] = tag("outflow")
    units: ClassVar[dict[str, str]] = {"time": "tau"}
    axis: Axis | None = param(
        None, doc="axis that the plane lies across (that of gravity, else x, unless said)"
    )
    at: float | None = param(
        None, doc="place of the plane (the middle of the box unless said)", unit="a"
    )
    window: Either[None, tuple[float, float]] = param(
        None, doc="[from, to] along each other axis: what passes beside it is left out", unit="a"
    )
    of: Literal["number", "mass", "volume"] = param("number", doc="what is drawn in time")
    width: float | None = param(
        None, doc="of the opening, or its diameter in 3D, for the law of Beverloo", unit="a", gt=0
    )
    fraction: float | None = param(
        None,
        doc="packing fraction of the bed, for that law (0.80 in 2D, 0.60 in 3D, unless said)",
        gt=0,
        le=1,
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for a plane or a window outside the box, and a law without gravity."""
        axes, size = case.box.axes, case.box.size
        if self.axis is not None and self.axis not in axes:
            raise CaseError(f"axis = {show(self.axis)}: expected one of {', '.join(axes)}")
        k = self.across(case)
        if self.at is not None and not 0 <= self.at <= size[k]:
            raise CaseError(f"at = {show(self.at)}: expected a place from 0 to {size[k]:g}")
        others = [j for j in range(len(axes)) if j != k]
        if self.window is not None and len(self.window) != len(others):
            along = " and ".join(axes[j] for j in others)
            raise CaseError(f"window = {show(self.window)}: expected [from, to] along {along}")
        for j, (low, high) in zip(others, self.window or (), strict=False):
            if not 0 <= low < high <= size[j]:
                raise CaseError(
                    f"window = {show(self.window)}: expected 0 <= from < to <= {size[j]:g} along "
                    f"{axes[j]}"
                )
        if self.width is not None and pull_axis(case) != k:
            raise CaseError(f"width = {show(self.width)}: expected gravity along {axes[k]}")
        if self.fraction is not None and self.width is None:
            raise CaseError(f"fraction = {show(self.fraction)}: no effect without width")

    def across(self, case: Case) -> int:
        """The axis that the plane lies across."""
        if self.axis is not None:
            return AXES.index(self.axis)
        pull = pull_axis(case)
        return 0 if pull is None else pull


@accumulator_of(Outflow)
class OutflowAccumulator(BlockAccumulator):
    """Rates of number, mass and volume since the sample before, as block averages and in time.

    Positive along gravity; without, along the axis. `before` are places at the last sample, `last`
    its time, `grain` the mean diameter, mass and volume of a grain.
    """

    memory: ClassVar[tuple[str, ...]] = ("blocks", "series", "before", "last", "grain", "passed")
    added: ClassVar[tuple[str, ...]] = ("passed",)

    def prepare(self) -> None:
        case, observable = self.case, self.observable
        self.axis = observable.across(case)
        self.length = float(case.box.size[self.axis])
        self.at = 0.5 * self.length if observable.at is None else observable.at
        closed = closed_axes(case)
        self.closed = self.axis in closed
        self.others = [k for k in range(case.box.dimension) if k != self.axis]
        size = np.array(case.box.size, float)[self.others]
        self.period = np.where([k in closed for k in self.others], np.inf, size)
        pull = pull_axis(case)
        downward = pull == self.axis and case.spheres.gravity[self.axis] < 0
        self.sign = -1.0 if downward else 1.0
        self.blocks, self.series = Blocks((3,)), TimeSeries(3)
        self.before = np.full((case.particles, case.box.dimension), np.nan)
        self.last, self.grain, self.passed = np.full(1, np.nan), np.full(3, np.nan), np.zeros(3)

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample: of what has passed since the last."""
        now, time, d = spheres.positions(unwrapped=True), spheres.time, spheres.dimension
        diameters, masses = spheres.diameters(), spheres.masses()
        amounts = np.stack([np.ones(spheres.n), masses, whole(0.5 * diameters, d)])
        self.grain = np.array([diameters.mean(), *amounts[1:].mean(axis=1)])
        if time > self.last[0]:
            passed = self.sign * amounts @ self.crossings(now)
            self.passed = self.passed + passed
            rates = passed / (time - self.last[0])
            self.blocks.add(rates)
            self.series.add(0.5 * (time + self.last[0]), rates)
        self.before, self.last = now, np.array([time])

    def crossings(self, now: Array) -> Array:
        """How often each grain has passed since the last sample, within the window."""
        period = math.inf if self.closed else self.length
        first, last = self.before[:, self.axis] - self.at, now[:, self.axis] - self.at
        if self.closed:
            number = (last >= 0).astype(float) - (first >= 0)
        else:
            number = np.floor(last / period) - np.floor(first / period)
        if self.observable.window is None:
            return number
        here = np.flatnonzero(number)
        planes = np.zeros(len(here))
        if not self.closed:  # the first that is crossed
            planes = period * (np.floor(first[here] / period) + (number[here] > 0))
        share = (planes - first[here]) / (last[here] - first[here])
        start, end = self.before[here][:, self.others], now[here][:, self.others]
        place = start + share[:, None] * (end - start)
        for j, length in enumerate(self.period):
            if np.isfinite(length):
                place[:, j] %= length
        low, high = np.array(self.observable.window, float).T
        number[here[~((place >= low) & (place <= high)).all(axis=1)]] = 0.0
        return number

    def result(self) -> Result:
        """The rate in time, mean rates, what has passed, and the law of Beverloo."""
        of, d = self.observable.of, self.case.box.dimension
        value, error, time = self.pieces()
        k, law = AMOUNTS.index(of), self.law()
        expected = None if np.isnan(law) else np.full(len(time), law * self.per_mass()[k])
        return self.report(
            {"time": time},
            (value[:, k], error[:, k]),
            self.comparisons(law),
            expected=expected,
            theory="" if expected is None else "Beverloo",
            label=f"{WORDS[of]} per time",
            units={"value": units_of(d)[of]},
        )

    def pieces(self) -> tuple[Array, Array, Array]:
        """Mean rates, their errors by the scatter of samples, and times, piece by piece."""
        rows, time = self.series.each(), self.series.time()  # (runs, n, 3)
        number = max(1, min(PIECES, len(time) // (2 * FEWEST)))
        values, errors, times = [], [], []
        for part in np.array_split(np.arange(len(time)), number) if len(time) else ():
            each = rows[:, part].reshape(-1, 3)
            values.append(each.mean(axis=0))
            known = len(each) >= FEWEST
            spread = (
                each.std(axis=0, ddof=1) / math.sqrt(len(each)) if known else np.full(3, np.nan)
            )
            errors.append(spread)
            times.append(float(time[part].mean()))
        shape = (len(times), 3)
        return np.reshape(values, shape), np.reshape(errors, shape), np.array(times)

    def per_mass(self) -> Array:
        """Number, mass and volume of grains of a mass of 1."""
        _, mass, volume = self.grain
        return np.array([1.0, mass, volume]) / mass

    def law(self) -> float:
        """Mass per time by the law of Beverloo; nan without an opening."""
        width, d = self.observable.width, self.case.box.dimension
        if width is None or not self.blocks.count:
            return math.nan
        size, mass, volume = (float(x) for x in self.grain)
        gravity = abs(float(self.case.spheres.gravity[self.axis]))
        density = self.fraction * mass / volume
        return float(theory.beverloo_rate(width, size, density, gravity, d))

    @property
    def fraction(self) -> float:
        """Packing fraction of the bed."""
        given: float | None = self.observable.fraction
        return USUAL_FRACTION[self.case.box.dimension] if given is None else given

    def comparisons(self, law: float) -> Iterator[Comparison]:
        """Mean rates, what has passed, and the rate of mass while a silo flows."""
        units, value, error = (
            units_of(self.case.box.dimension),
            self.blocks.mean(),
            self.blocks.error(),
        )
        for k, of in enumerate(AMOUNTS):
            yield Comparison(f"mean rate of {WORDS[of]}", value[k], error[k], unit=units[of])
        yield Comparison("grains that passed", self.passed[0], math.nan)
        if self.observable.width is None:
            return
        flowing = self.flowing()
        if flowing.count:
            note = f"approximate: Beverloo, of a bed with a packing fraction of {self.fraction:g}"
            mean = float(flowing.mean()), float(flowing.error())
            yield Comparison("rate of mass while it flows", *mean, law, units["mass"], note)

    def flowing(self) -> Blocks:
        """Rates of mass from when a tenth of what passes has passed until only a tenth is left."""
        found = Blocks()
        for run in self.series.each():
            passed = np.cumsum(run[:, 1])
            if not len(passed) or not passed[-1] > 0:
                continue
            low, high = np.searchsorted(passed, np.array(SHARES) * passed[-1])
            for rate in run[low + 1 : high + 1, 1]:
                found.add(rate)
        return found


def units_of(dimension: int) -> dict[str, str]:
    """Units of the rates."""
    return {"number": "1/tau", "mass": "m/tau", "volume": f"a^{dimension}/tau"}
