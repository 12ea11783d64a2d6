"""Stress in time while the shear changes: what a rheometer draws."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, option, param, show, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import springs_in
from mesokit.method.mpcd.expected.rheometer import shear_note, spreading_time, stress_of_history
from mesokit.method.mpcd.observe.shared.molecule_tensor import kept
from mesokit.method.mpcd.observe.stress import UNIT
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of, unpack
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks, student

SHEAR, BONDS, FIRST = "shear stress", "shear stress of bonds", "first normal-stress difference"
SQUARES = {SHEAR: 1.0, BONDS: 1.0, FIRST: 4.0}  # of x y and x x - y y, of Gaussians
MOST_ROWS = 10_000  # windows kept in memory


@component
class StressInTime(Observable):
    """Shear stress and first normal-stress difference as functions of time, averaged over windows.

    Where the shear has a period they are folded onto it, and repetitions give the error bars;
    otherwise runs with other seeds that are pooled do, from four on. Few of them may agree by
    chance: error bars have Student's factor, and are at least what springs at rest fluctuate.
    """

    quantity: Literal["stress-in-time"] = tag("stress-in-time")
    measures: ClassVar[tuple[str, ...]] = ("stress",)
    every: int = option(default=1, doc="steps between two samples", ge=1, kw_only=True)
    window: int = param(10, doc="steps that a point is the mean over", unit="steps", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError between walls, and for windows that do not fit."""
        if case.walls:
            raise CaseError("stress is measured without walls; use wall-stress")
        if self.window % self.every:
            raise CaseError(
                f"window = {self.window}: expected a multiple of every = {self.every}, the steps "
                "between two samples"
            )
        steps = steps_of_period(case)
        period = case.box.history.repeats_after if case.box.history is not None else None
        if period is not None and steps is None and case.box.oscillation is None:
            raise CaseError(
                f"box.shear.period = {show(period)}: stress-in-time expects whole timesteps of "
                f"{show(case.fluid.timestep)}"
            )
        if steps is not None and steps % self.window:
            raise CaseError(
                f"window = {self.window}: expected a divisor of {steps}, the steps of a period of "
                "the shear"
            )
        rows = (steps or case.run.warmup + case.run.steps) / self.window
        if rows > MOST_ROWS:
            least = math.ceil(rows * self.window / MOST_ROWS)
            raise CaseError(f"window = {self.window}: expected at least {least}, for so many steps")

    def warnings(self, case: Case) -> Iterator[str]:
        """A run that sees no whole period."""
        steps = steps_of_period(case)
        if steps is not None and -(-case.run.warmup // steps) * steps + steps > (
            case.run.warmup + case.run.steps
        ):
            yield (
                f"{self.label}: no whole period of the shear ({steps} steps) after the warm-up; "
                "nothing will be told"
            )


def steps_of_period(case: Case) -> int | None:
    """Steps after which the shear repeats; None if it does not, or not at a step."""
    period = case.box.history.repeats_after if case.box.history is not None else None
    if period is None:
        return None
    steps = round(period / case.fluid.timestep)
    fits = steps > 0 and abs(steps * case.fluid.timestep - period) < 1e-6 * case.fluid.timestep
    return steps if fits else None


@accumulator_of(StressInTime)
class StressInTimeAccumulator(BlockAccumulator):
    """Sums over the windows of the time that is under way, and block averages of whole periods."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "sums", "counts", "first", "samples")

    def __init__(self, observable: StressInTime, case: Case) -> None:
        self.case, self.name, self.window = case, observable.label, observable.window
        self.samples_of_window = observable.window // observable.every
        self.bonded = case.fluid.molecule is not None or case.solutes is not None
        self.mass = setting.mass_density(case) * case.box.volume
        self.components = (SHEAR, *((BONDS,) if self.bonded else ()), FIRST)
        self.period = steps_of_period(case)
        self.springs = springs_in(case)
        self.rows = (self.period or case.run.warmup + case.run.steps) // observable.window
        self.sums = np.zeros((self.rows, len(self.components)))
        self.counts = np.zeros(self.rows, np.int64)
        self.blocks = Blocks((self.rows, len(self.components)))
        self.first = np.full(1, -1)  # number of the first whole period
        self.samples = np.zeros(1, np.int64)
        self.others: list[StressInTimeAccumulator] = []  # pooled with it

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample: the stress of a step belongs to the window in which the step ends."""
        before = fluid.step - 1
        repetition, inside = divmod(before, self.period) if self.period else (0, before)
        row = inside // self.window
        if row >= self.rows:  # the run is longer than its case says
            self.lengthen(max(row + 1, 2 * self.rows))
        stress = np.sum(list(fluid.stress.values()), axis=0)
        # images that change their speed hand momentum to those that lie across the edge of the box:
        # how the fluid moves as a whole is no stress
        drift = fluid.totals()[1] / self.mass
        stress += self.mass / self.case.box.volume * np.outer(drift, drift)
        self.sums[row] += [
            stress[0, 1],
            *([fluid.stress["bond"][0, 1]] if self.bonded else []),
            stress[0, 0] - stress[1, 1],
        ]
        self.counts[row] += 1
        self.samples += 1
        if self.period and row == self.rows - 1 and self.counts[row] == self.samples_of_window:
            self.close(repetition)

    def close(self, repetition: int) -> None:
        """Keep a period that has been seen whole, and begin the next."""
        if (self.counts == self.samples_of_window).all():
            self.blocks.add(self.sums / self.samples_of_window)
            self.first[0] = repetition if self.first[0] < 0 else self.first[0]
        self.sums[:], self.counts[:] = 0.0, 0

    def lengthen(self, rows: int) -> None:
        """Make room for more windows of a time that does not repeat."""
        more = rows - self.rows
        self.sums = np.concatenate([self.sums, np.zeros((more, len(self.components)))])
        self.counts = np.concatenate([self.counts, np.zeros(more, np.int64)])
        self.rows = rows

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`, maybe of a run that was to be shorter or longer."""
        if self.period:
            self.blocks = Blocks.from_state(unpack(state, "blocks"))
        known = len(state["counts"])
        if known > self.rows:
            self.lengthen(known)
        self.sums[:known], self.counts[:known] = state["sums"], state["counts"]
        self.first, self.samples = np.array(state["first"]), np.array(state["samples"])

    def pool(self, other: StressInTimeAccumulator) -> None:
        super().pool(other)
        self.others.append(other)

    def estimate(self) -> tuple[NDArray[np.int64], Estimate]:
        """Rows that are known, and their means, flat, with what each repetition adds to them."""
        if self.period:
            sums, weights = self.blocks.sums()
            rows = np.arange(self.rows if self.blocks.count else 0)
        else:
            every = (self, *self.others)
            shortest = min(one.rows for one in every)
            whole = np.all(
                [one.counts[:shortest] == self.samples_of_window for one in every], axis=0
            )
            rows = np.flatnonzero(whole)
            sums = np.stack([one.sums[:shortest] / self.samples_of_window for one in every])
            weights = np.ones(len(every), np.int64)
        if not len(rows):
            return rows, Estimate(np.zeros(0), np.zeros((0, 0)), weights.astype(float))
        flat = sums[:, rows].reshape(len(sums), -1)
        mean = flat.sum(axis=0) / weights.sum()
        residuals = (flat - np.multiply.outer(weights, mean)) / weights.sum()
        return rows, Estimate(mean, residuals, weights.astype(float))

    def result(self) -> Result:
        """Stress by window, with theory."""
        rows, flat = self.estimate()
        shape = (len(rows), len(self.components))
        timestep, expected = self.case.fluid.timestep, self.expected(rows)
        history = self.case.box.history
        edges = (rows[:, None] + np.array([0, 1])) * self.window * timestep
        strain = np.zeros(edges.shape) if history is None else history.strain_at(edges)
        many = len(flat.weights) > 3 and len(rows) > 0
        error = np.full(shape, np.nan)
        if many:
            known = flat.error.reshape(shape) * student(len(flat.weights))
            error = np.maximum(known, self.scatter(flat))
        return Result(
            quantity="stress-in-time",
            drawing="stress in time",
            name=self.name,
            x={"time": edges.mean(axis=1), "component": np.array(self.components)},
            value=flat.value.reshape(shape),
            error=error,
            label="stress",
            units={"value": UNIT[self.case.box.dimension], "time": "tau", "component": ""},
            expected=expected,
            theory="Newtonian fluid" if self.case.fluid.molecule is None else "Rouse",
            comparisons=tuple(self.comparisons(rows, flat, expected)) if many else (),
            samples=int(sum(one.samples[0] for one in (self, *self.others))),
            extra={
                "rate": np.diff(strain, axis=1)[:, 0] / (self.window * timestep),
                "strain": strain.mean(axis=1),
                "repetitions": int(flat.weights.sum()) if len(rows) else 0,
            },
        )

    def expected(self, rows: NDArray[np.int64]) -> Array | None:
        """What theory says of these rows: of the average over the periods that were seen."""
        count = self.blocks.count // (1 + len(self.others)) if self.period else 1
        first = max(int(self.first[0]), 0)
        if not len(rows):
            return None
        last = self.rows if self.period else int(rows[-1]) + 1
        found = stress_of_history(self.case, last * self.window, first, count)
        if found is None:
            return None
        by_component = {SHEAR: found.shear, BONDS: found.molecules, FIRST: found.first}
        columns = [by_component[name] for name in self.components]
        windows = np.stack(columns, axis=1).reshape(last, self.window, -1).mean(axis=1)
        return np.asarray(windows[rows])

    def fluctuation(self, lag: Array) -> Array:
        """Correlation of the shear stress of springs at rest, of windows that are a lag apart."""
        scale = (self.case.fluid.kT / self.case.box.volume) ** 2
        window = self.window * self.case.fluid.timestep
        return scale * sum(
            (
                number * np.where(lag > 0, np.exp(-lag / tau), kept(window / tau))
                for number, times in self.springs
                for tau in times.stress.tolist()
            ),
            start=np.zeros(np.shape(lag)),
        )

    def scatter(self, flat: Estimate) -> Array:
        """Least errors (components,) of single windows by how much springs at rest fluctuate."""
        single = float(self.fluctuation(np.zeros(())))
        repetitions = flat.weights.sum()
        return np.array([(SQUARES[name] * single / repetitions) ** 0.5 for name in self.components])

    def of_factor(self, rows: NDArray[np.int64], flat: Estimate, weight: Array, name: str) -> float:
        """Least error of a sum of windows (rows,), of one component: few repetitions may agree by
        chance."""
        number = int(rows[-1]) + 1
        regular = np.zeros(2 * number)  # the other half so that no end meets the other
        regular[rows] = weight
        pairs = np.fft.irfft(abs(np.fft.rfft(regular)) ** 2)[:number]
        correlation = self.fluctuation(np.arange(number) * self.window * self.case.fluid.timestep)
        variance = 2 * pairs @ correlation - pairs[0] * correlation[0]
        return float(max(SQUARES[name] * variance / flat.weights.sum(), 0.0) ** 0.5)

    def comparisons(
        self, rows: NDArray[np.int64], flat: Estimate, expected: Array | None
    ) -> list[Comparison]:
        """By which factor the curves differ from those of theory, by least squares."""
        if expected is None:
            return []
        found, molecules = [], self.case.fluid.molecule is not None
        for k, name in enumerate(self.components):
            weight = np.zeros(expected.shape)
            square = (expected[:, k] ** 2).sum()
            if not square > 0:
                continue
            weight[:, k] = expected[:, k] / square
            value, error = flat.scalar(flat.value @ weight.ravel(), weight.ravel())
            error *= student(len(flat.weights))
            error = max(error, self.of_factor(rows, flat, weight[:, k], name))
            note = setting.chaos_is_off(self.case, 1.0, error)
            if molecules:
                note = shear_note(self.case)
            if name == FIRST:
                note = (
                    "approximate: of uniform shear, which takes "
                    f"{spreading_time(self.case):.2g} tau to spread from the images"
                )
            found.append(Comparison(f"{name} over theory", value, error, 1.0, "", note))
        return found
