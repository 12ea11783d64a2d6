"""Number, momentum, energy and temperature of the whole fluid in time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.case.component import component, tag
from mesokit.method.mpcd.columns import freedoms, holds, in_random_solvent, temperature
from mesokit.method.mpcd.expected import setting
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, Observable, State, accumulator_of
from mesokit.seam.result import NOT_STEADY, Array, Comparison, Result
from mesokit.statistics import Blocks

ENERGY = "m a^2/tau^2"
LEFT = ("put back", "still hitting")  # particles that bodies leave over
ROWS = 4096  # kept of the time series; every other one is dropped when they are full


@component
class Conservation(Observable):
    """Number, momentum, kinetic energy and temperature of the whole fluid in time.

    The temperature is that of the motion about the mean velocity, flow included. Fluids of
    molecules and solutes have a potential energy as well. Solutes and bodies that move count as
    particles; in a random solvent solutes are all there is. Bodies turn, too, which adds to the
    energy; their virtual particles exchange energy with them. With bodies it counts the particles
    that had to be put back out of one in a step, and those that still hit in the last round of
    hits: both should be few.
    """

    quantity: Literal["conservation"] = tag("conservation")
    in_open_box: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False
    at_any_kT: ClassVar[tuple[str, ...]] = ("",)
    drawing = "series"
    value_label = "conserved quantities"


@accumulator_of(Conservation)
class ConservationAccumulator(BlockAccumulator):
    """The first sample, a thinned time series, block averages and the largest drift."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "first", "drift", "counts", "left")

    def prepare(self) -> None:
        case = self.case
        self.dimension = case.box.dimension
        self.bonded = case.fluid.molecule is not None or case.solutes is not None
        self.in_random_solvent = in_random_solvent(case)
        taken = bool(case.walls) or self.in_random_solvent or holds(case)
        self.conserves_momentum = not (taken or setting.gives_momentum(case))
        changes = setting.isothermal(case) or bool(case.bodies)
        self.conserves_energy = self.conserves_momentum and not changes
        # number, momentum, the potential energy of bonds and pairs, kinetic energy, temperature
        width = 3 + self.dimension + self.bonded
        self.blocks = Blocks((width,))
        self.rows = np.zeros((ROWS, 2 + width))  # step and time first
        self.first = np.zeros(width)
        self.drift = np.zeros(2)  # largest change of momentum and of kinetic energy so far
        self.counts = np.array([0, 1, 0])  # rows kept, samples per row, samples
        self.left = np.zeros(len(LEFT))  # particles that bodies left over, in all samples
        self.pooled = 1  # runs

    def observe(self, fluid: Any) -> None:
        number, momentum, energy = fluid.totals()
        if self.case.bodies:
            found = fluid.bodies.counts()
            self.left += [found[name] for name in LEFT]
        warmth = temperature(self.case, number, momentum, energy)
        bound = [fluid.potential_energy()] if self.bonded else []
        sample = np.array([number, *momentum, *bound, energy, warmth])
        kept, stride, samples = self.counts
        if samples == 0:
            self.first = sample
        change = sample - self.first
        last = self.dimension + 1
        largest = [np.linalg.norm(change[1:last]), abs(change[last:-1].sum())]
        self.drift = np.maximum(self.drift, largest)
        self.blocks.add(sample)
        if samples % stride == 0:
            if kept == ROWS:
                self.rows[: ROWS // 2] = self.rows[::2]
                kept, stride = ROWS // 2, 2 * stride
            if samples % stride == 0:
                self.rows[kept] = [fluid.step, fluid.time, *sample]
                kept += 1
        self.counts = np.array([kept, stride, samples + 1])

    def state(self) -> State:
        return super().state() | {"rows": self.rows[: self.counts[0]].copy()}

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        super().restore(state)
        self.rows[: len(state["rows"])] = state["rows"]

    def pool(self, other: ConservationAccumulator) -> None:
        """The time series becomes the mean of both, where both have kept a row."""
        super().pool(other)
        own, others = self.rows[: self.counts[0]], other.rows[: other.counts[0]]
        _, here, there = np.intersect1d(own[:, 0], others[:, 0], return_indices=True)
        share = 1 / (1 + self.pooled)
        rows = (1 - share) * own[here] + share * others[there]
        rows[:, 0] = own[here, 0]
        self.rows[: len(rows)] = rows
        self.first = (1 - share) * self.first + share * other.first
        self.drift = np.maximum(self.drift, other.drift)
        self.left = self.left + other.left
        self.counts = np.array([len(rows), self.counts[1], self.counts[2] + other.counts[2]])
        self.pooled += 1

    def result(self) -> Result:
        rows = self.rows[: self.counts[0]]
        names = ["number", *(f"momentum_{a}" for a in AXES[: self.dimension])]
        names += ["potential_energy"] * self.bonded + ["kinetic_energy", "temperature"]
        value = rows[:, 2:].copy()
        units = {"time": "tau", "number": "", "temperature": ENERGY}
        units |= {name: ENERGY for name in names if name.endswith("energy")}
        units |= {name: "m a/tau" for name in names if name.startswith("momentum")}
        return self.report(
            {"time": rows[:, 1].copy(), "component": names},
            value,
            self._comparisons(),
            units=units,
            expected=self._expected(value, rows[:, 1]),
            theory="kT of the case, conservation",
            samples=int(self.counts[2]),
            extra={
                "step": rows[:, 0].copy(),
                "mean": self.blocks.mean(),
                "mean_error": self.blocks.error(),
                "conserves_momentum": int(self.conserves_momentum),
                "conserves_energy": int(self.conserves_energy),
                "driven": int(setting.driven(self.case)),
                "not_steady": self._not_steady(),
            },
        )

    def _expected(self, value: Array, time: Array) -> Array:
        expected = np.full(value.shape, np.nan)
        expected[:, 0] = self.first[0]
        if self.conserves_momentum:
            expected[:, 1 : self.dimension + 1] = self.first[1 : self.dimension + 1]
        elif not self.in_random_solvent and len(time):
            for axis in range(self.dimension):
                expected[:, 1 + axis] = self._driven_momentum(axis, time - time[0])
        if self.conserves_energy and not self.bonded:
            expected[:, -2:] = self.first[-2:]
        elif setting.isothermal(self.case) or self.in_random_solvent:
            energy, momentum = self._held_energy()
            warmth = temperature(self.case, int(self.first[0]), momentum, energy)
            expected[:, -2:] = energy, warmth
        return expected

    def _held_energy(self) -> tuple[float, Array]:
        """Kinetic energy and momentum of the steady flow of a fluid at kT, nan without theory."""
        case, d = self.case, self.dimension
        held = case.walls or self.in_random_solvent or holds(case)
        mass = setting.superficial_mass(case)
        squares, momentum = 0.0, np.zeros(d)
        for axis in range(d):
            flow = setting.flow(case, axis)
            among = setting.obstructed(case) or bool(case.bodies)
            if flow.profile is None or (setting.driven(case) and among):
                return np.nan, momentum
            edges = np.linspace(0.0, case.box.size[flow.across], 65)
            speeds = setting.bin_average(flow.profile, edges)
            squares += float((speeds**2).mean())
            momentum[axis] = mass * float(speeds.mean())
        thermal = freedoms(case, int(self.first[0]), free=not held) * case.fluid.kT
        return 0.5 * float(thermal + mass * squares), momentum

    def _not_steady(self) -> str:
        """Note that samples began before the flow had built up; "" where they did not."""
        found = method_of(self.case).steadiness.build_up(self.case)
        if found is None or found.had >= found.need:
            return ""
        return f"{NOT_STEADY}: the flow needs {found.need} steps before samples, had {found.had}"

    def _driven_momentum(self, axis: int, since: Array) -> Array | float:
        """Of the steady flow, or of a fluid that nothing holds; nan where there is no theory."""
        case, flow = self.case, setting.flow(self.case, axis)
        mass = setting.superficial_mass(case)
        if case.bodies:
            return np.nan
        if flow.kind == "accelerating" and not case.walls:
            acceleration = float(setting.uniform_acceleration(case)[axis])
            return self.first[1 + axis] + mass * acceleration * since
        if flow.profile is None or setting.obstructed(case):
            return np.nan
        edges = np.linspace(0.0, case.box.size[flow.across], 65)
        return mass * float(setting.bin_average(flow.profile, edges).mean())

    def _comparisons(self) -> Iterator[Comparison]:
        fluid, exact = self.case.fluid, "exact: only rounding may show"
        if self.conserves_momentum:
            # the total is zero, so relative to what the momenta would add up to without signs
            drift = self.drift[0] / (self.first[0] * fluid.mass * (fluid.kT / fluid.mass) ** 0.5)
            yield Comparison("largest drift of momentum", drift, 0.0, 0.0, "N sqrt(m kT)", exact)
        if self.conserves_energy:
            drift = self.drift[1] / float(self.first[self.dimension + 1 : -1].sum())
            if self.bonded:
                kind, expected, note = "total", np.nan, "falls with the square of the sub-step"
            else:
                kind, expected, note = "kinetic", 0.0, exact
            what = f"largest relative drift of {kind} energy"
            yield Comparison(what, drift, 0.0, expected, "", note)
        if (setting.isothermal(self.case) or self.in_random_solvent) and not setting.driven(
            self.case
        ):
            mean, error = self.blocks.mean()[-1], self.blocks.error()[-1]
            note = setting.temperature_note(self.case)
            yield Comparison("temperature", mean, error, fluid.kT, "", note)
        for name, number in zip(LEFT, self.left, strict=True) if self.case.bodies else ():
            in_a_step = float(number) / max(int(self.counts[2]), 1)
            yield Comparison(f"particles {name} in a step", in_a_step, np.nan, np.nan)
