"""Temperature of spheres in time: of their motion and of their rotation."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal, Protocol

import numpy as np

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.expected.cooling import Cooling
from mesokit.method.spheres.common.observe.protocol import OfSpheres, Samples
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.method import method_of
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import LOWER_BOUND, Array, Comparison, Result

PARTS, UNIT = ("translation", "rotation"), "m a^2/tau^2"


class CoolingInTime(Protocol):
    """Theory by a method: the kind of cooling, and the time of Haff's law from a temperature."""

    known: Cooling

    def haff_time(self, kT: float) -> float: ...


@component
class GranularTemperature(OfSpheres):
    """Twice the kinetic energy per degree of freedom, of translation and of rotation.

    Translation is about the mean velocity. A gas of smooth inelastic spheres cools by Haff's law as
    long as it is uniform; collisions of hard spheres so far are in the table as well.
    """

    quantity: Literal["granular-temperature"] = tag("granular-temperature")
    value_label = "temperature $k_B T$"
    units: ClassVar[dict[str, str]] = {"value": UNIT, "time": "tau", "of": ""}


@accumulator_of(GranularTemperature)
class GranularTemperatureAccumulator(Samples):
    """Both temperatures, and collisions of a sphere so far, in time."""

    added: ClassVar[tuple[str, ...]] = ("samples", "runs")
    width, runs = 3, 1

    def prepare(self) -> None:
        super().prepare()
        expected = method_of(self.case).expected["granular-temperature"]
        self.theory: CoolingInTime = expected(self.case, self.observable)
        self.known = self.theory.known
        self.law = ""  # name of the law beside the series
        if not math.isnan(self.known.held):
            self.law = "bath"
        elif not math.isnan(self.known.restitution):
            self.law = "conserved" if self.known.restitution == 1 else "Haff"

    def observe(self, spheres: RunningSpheres) -> None:
        n, d = spheres.n, spheres.dimension
        energies, (_, momentum, _), masses = spheres.energies(), spheres.totals(), spheres.masses()
        about_mean = 2 * energies["translation"] - momentum @ momentum / masses.sum()
        motion = about_mean / (d * max(n - 1, 1))
        turning = 2 * energies["rotation"] / ((1 if d == 2 else 3) * n)
        pairs = getattr(spheres, "collisions", (math.nan,))[0]  # soft ones do not count them
        self.series.add(spheres.time, [motion, turning, 2 * pairs / n])
        self.samples += 1

    def result(self) -> Result:
        """The series, with error bars where four runs or more are pooled."""
        time, rows = self.series.time(), self.series.values()
        shown = PARTS if self.known.turns else PARTS[:1]
        return self.report(
            {"time": time, "of": shown},
            (rows[:, : len(shown)], self.series.error()[:, : len(shown)]),
            self.comparisons(time, rows),
            drawing="cooling" if self.law == "Haff" else "curve",
            expected=self.expected(time, rows, len(shown)),
            theory=self.law,
            samples=self.samples,
            extra={} if np.isnan(rows[:, 2]).any() else {"collisions": rows[:, 2].copy()},
        )

    def expected(self, time: Array, rows: Array, width: int) -> Array | None:
        """Of translation: what a bath holds, or Haff's law from the first sample on."""
        if not self.law or not len(time):
            return None
        found, first = np.full((len(time), width), np.nan), rows[0, 0]
        if self.law == "bath":
            found[:, 0] = self.known.held
        else:
            haff = self.theory.haff_time(first)
            found[:, 0] = first * theory.haff_temperature(time - time[0], haff)
        return found

    def comparisons(self, time: Array, rows: Array) -> Iterator[Comparison]:
        """The temperature at the end, and where it has fallen to a quarter, while the gas is still
        uniform; there also beside the collisions that there were."""
        if len(time) < 2:
            return
        law, note, errors = self.expected(time, rows, 1), self.note(), self.series.error()
        (motion, turning, _), end = rows[-1], errors[-1]
        known = math.nan if law is None else law[-1, 0]
        error = self.error(motion, end[0])
        yield Comparison("temperature at the end", motion, error, known, UNIT, note)
        if self.known.turns:
            yield Comparison("of rotation at the end", turning, end[1], unit=UNIT)
        quarter = np.flatnonzero(rows[:, 0] <= 0.25 * rows[0, 0])
        if law is None or self.law != "Haff" or not len(quarter):
            return
        k, e, first = quarter[0], self.known.restitution, rows[0, 0]
        found, error = rows[k, 0], self.error(rows[k, 0], errors[k, 0])
        what = f"temperature at t = {time[k]:.4g}"
        yield Comparison(what, found, error, law[k, 0], UNIT, note)
        # a sphere loses (1 - e^2)/d of its mean energy in each collision, in molecular chaos
        collisions = rows[k, 2] - rows[0, 2]
        if not math.isnan(collisions):
            lost = math.exp(-(1 - e**2) * collisions / self.case.box.dimension)
            what = f"temperature after {collisions:.3g} collisions of each"
            yield Comparison(what, found, error, first * lost, UNIT, note)

    def error(self, kT: float, of_runs: float) -> float:
        """Of a temperature: 0 where collisions keep it, what a bath leaves of Maxwell's velocities,
        else `of_runs`, by how runs scatter.

        In one run that cools by Haff's law it is that of as many independent velocities: measured
        with 637 disks of restitution 0.8, runs scatter by 0.7 of it at a quarter of the temperature
        and by all of it at a tenth.
        """
        known = self.known
        degrees = self.case.box.dimension * max(self.case.particles - 1, 1)
        independent = math.sqrt(2 / (degrees * self.runs))
        if self.law == "bath":
            averaged = not known.fluctuates or self.series.stride > 1
            return of_runs if averaged else float(known.held * independent)
        if self.law == "conserved" and known.contact_time == 0 and not self.case.walls:
            return 0.0
        if self.law == "Haff" and math.isnan(of_runs):
            return kT * independent
        return of_runs

    def note(self) -> str:
        """Note on what the law neglects."""
        if self.law == "Haff":
            chaos = "approximate: molecular chaos, without clusters or pairs that meet again"
            single = np.isnan(self.series.error()).all()
            return f"{chaos}; {LOWER_BOUND}: as if velocities were independent" if single else chaos
        if self.law == "conserved" and self.known.contact_time > 0:
            return "approximate: contacts hold a part of the energy"
        return ""
