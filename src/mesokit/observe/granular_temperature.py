"""Temperature of spheres in time: of their motion and of their rotation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.observe.shared.protocol import Observable, State, pack, unpack
from mesokit.observe.shared.result import Array, Comparison, Result
from mesokit.statistics import TimeSeries

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.engine import RunningSpheres

PARTS, UNIT = ("translation", "rotation"), "m a^2/tau^2"


@component
class GranularTemperature(Observable):
    """Twice the kinetic energy per degree of freedom, of translation and of rotation.

    Translation is about the mean velocity. A gas of smooth inelastic spheres cools by Haff's law as
    long as it is uniform; collisions so far are in the table as well.
    """

    quantity: Literal["granular-temperature"] = tag("granular-temperature")
    methods: ClassVar[tuple[str, ...]] = ("event-driven",)
    needs_fluid: ClassVar[bool] = False

    def accumulator(self, case: Case) -> GranularTemperatureAccumulator:
        """An empty memory for it."""
        return GranularTemperatureAccumulator(self, case)


class GranularTemperatureAccumulator:
    """The series in time."""

    def __init__(self, observable: GranularTemperature, case: Case) -> None:
        self.name, self.case = observable.label, case
        self.series = TimeSeries(3)  # both temperatures, collisions of a sphere
        self.samples = 0

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample."""
        n, d = spheres.n, spheres.dimension
        energies, (_, momentum, _) = spheres.energies(), spheres.totals()
        masses = spheres.masses()
        about_mean = 2 * energies["translation"] - momentum @ momentum / masses.sum()
        motion = about_mean / (d * max(n - 1, 1))
        turning = 2 * energies["rotation"] / ((1 if d == 2 else 3) * n)
        self.series.add(spheres.time, [motion, turning, 2 * spheres.collisions[0] / n])
        self.samples += 1

    def state(self) -> State:
        """All it has to remember."""
        return pack(series=self.series, samples=np.array(self.samples))

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.series = TimeSeries.from_state(unpack(state, "series"))
        self.samples = int(state["samples"])

    def pool(self, other: GranularTemperatureAccumulator) -> None:
        """Take in an independent run of the same case, only to read: the series becomes a mean."""
        self.series.pool(other.series)
        self.samples += other.samples

    def result(self) -> Result:
        """The series; a sample has no error bar: nan."""
        time, rows = self.series.time(), self.series.values()
        shown = PARTS if self.case.spheres.collision.rough else PARTS[:1]
        value = rows[:, : len(shown)]
        return Result(
            quantity="granular-temperature",
            drawing="cooling" if self.law() == "Haff" else "curve",
            name=self.name,
            x={"time": time, "of": np.array(shown)},
            value=value,
            error=np.full(value.shape, np.nan),
            label="temperature $k_B T$",
            units={"value": UNIT, "time": "tau", "of": ""},
            expected=self.expected(time, rows, len(shown)),
            theory=self.law(),
            comparisons=tuple(self.comparisons(time, rows)),
            samples=self.samples,
            extra={"collisions": rows[:, 2].copy()},
        )

    def uniform(self) -> bool:
        """Whether theory knows how it goes: smooth equal spheres, nothing beside them."""
        section = self.case.spheres
        one = len(section.kinds) == 1 and section.kinds[0].spread == 0
        smooth = not section.collision.rough and hasattr(section.collision, "restitution")
        return one and smooth and not self.case.walls and not section.gravity

    def law(self) -> str:
        """Whose law is beside it."""
        if not self.uniform():
            return ""
        return "conserved" if self.case.spheres.collision.elastic else "Haff"

    def haff(self, kT: float) -> float:
        """The time of Haff's law, from a temperature; infinite of elastic spheres."""
        section, box = self.case.spheres, self.case.box
        kind, d = section.kinds[0], box.dimension
        if section.collision.elastic:
            return math.inf
        rate = theory.enskog_rate(
            self.case.particles / box.volume,
            kind.diameter * section.scale(box),
            kT / kind.mean_mass(d),
            section.fraction(box),
            d,
        )
        return theory.haff_time(section.collision.restitution, rate, d)

    def expected(self, time: Array, rows: Array, width: int) -> Array | None:
        """Haff's law from the first sample on."""
        if not self.uniform() or not len(time):
            return None
        found = np.full((len(time), width), np.nan)
        first = rows[0, 0]
        found[:, 0] = first * theory.haff_temperature(time - time[0], self.haff(first))
        return found

    def comparisons(self, time: Array, rows: Array) -> list[Comparison]:
        """The temperature at the end, and where it has fallen to a quarter, while the gas is still
        uniform; there also beside the collisions that there were."""
        if len(time) < 2:
            return []
        law, nan = self.expected(time, rows, 1), math.nan
        cooling = self.law() == "Haff"
        note = "approximate: the law is that of a uniform gas" if cooling else ""
        known = nan if law is None else float(law[-1, 0])
        listed = [Comparison("temperature at the end", float(rows[-1, 0]), nan, known, UNIT, note)]
        quarter = np.flatnonzero(rows[:, 0] <= 0.25 * rows[0, 0])
        if law is not None and cooling and len(quarter):
            k, e = quarter[0], self.case.spheres.collision.restitution
            found, at = float(rows[k, 0]), f"at t = {time[k]:.4g}"
            listed.append(Comparison(f"temperature {at}", found, nan, float(law[k, 0]), UNIT, note))
            # a sphere loses (1 - e^2)/d of its mean energy in each collision, in molecular chaos
            collisions = rows[k, 2] - rows[0, 2]
            lost = math.exp(-(1 - e**2) * collisions / self.case.box.dimension)
            what = f"temperature after {collisions:.3g} collisions of each"
            listed.append(Comparison(what, found, nan, float(rows[0, 0]) * lost, UNIT, note))
        return listed
