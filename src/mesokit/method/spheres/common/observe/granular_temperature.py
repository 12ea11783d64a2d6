"""Temperature of spheres in time: of their motion and of their rotation."""

import math
from typing import ClassVar, Literal, Protocol

import numpy as np

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.observe.samples import Samples
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.method import method_of
from mesokit.seam.observable import Observable, accumulator_of
from mesokit.seam.result import LOWER_BOUND, Array, Comparison, Result

PARTS, UNIT = ("translation", "rotation"), "m a^2/tau^2"


class CoolingTheory(Protocol):
    """What is known: see `spheres.expected.cooling`."""

    turns: bool
    restitution: float
    held: float
    fluctuates: bool
    contact_time: float


class CoolingInTime(Protocol):
    """What a method says of it: what is known, and the time of Haff's law from a temperature."""

    known: CoolingTheory

    def haff_time(self, kT: float) -> float: ...


@component
class GranularTemperature(Observable):
    """Twice the kinetic energy per degree of freedom, of translation and of rotation.

    Translation is about the mean velocity. A gas of smooth inelastic spheres cools by Haff's law as
    long as it is uniform; collisions of hard spheres so far are in the table as well.
    """

    quantity: Literal["granular-temperature"] = tag("granular-temperature")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    of_methods_alone: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False


@accumulator_of(GranularTemperature)
class GranularTemperatureAccumulator(Samples):
    """The series in time."""

    added: ClassVar[tuple[str, ...]] = ("samples", "runs")

    def __init__(self, observable: GranularTemperature, case: Case) -> None:
        self.name, self.case = observable.label, case
        self.theory: CoolingInTime = method_of(case).expected["granular-temperature"](
            case, observable
        )
        super().__init__(3)  # both temperatures, collisions of a sphere
        self.runs = 1

    def observe(self, spheres: RunningSpheres) -> None:
        n, d = spheres.n, spheres.dimension
        energies, (_, momentum, _) = spheres.energies(), spheres.totals()
        masses = spheres.masses()
        about_mean = 2 * energies["translation"] - momentum @ momentum / masses.sum()
        motion = about_mean / (d * max(n - 1, 1))
        turning = 2 * energies["rotation"] / ((1 if d == 2 else 3) * n)
        pairs = getattr(spheres, "collisions", (math.nan,))[0]  # soft ones do not count them
        self.series.add(spheres.time, [motion, turning, 2 * pairs / n])
        self.samples += 1

    def result(self) -> Result:
        """The series, with error bars where four runs or more are pooled."""
        time, rows = self.series.time(), self.series.values()
        shown = PARTS if self.theory.known.turns else PARTS[:1]
        value = rows[:, : len(shown)]
        return Result(
            quantity="granular-temperature",
            drawing="cooling" if self.law() == "Haff" else "curve",
            name=self.name,
            x={"time": time, "of": np.array(shown)},
            value=value,
            error=self.series.error()[:, : len(shown)],
            label="temperature $k_B T$",
            units={"value": UNIT, "time": "tau", "of": ""},
            expected=self.expected(time, rows, len(shown)),
            theory=self.law(),
            comparisons=tuple(self.comparisons(time, rows)),
            samples=self.samples,
            extra={} if np.isnan(rows[:, 2]).any() else {"collisions": rows[:, 2].copy()},
        )

    def law(self) -> str:
        """Whose law is beside it."""
        known = self.theory.known
        if not math.isnan(known.held):
            return "bath"
        if math.isnan(known.restitution):
            return ""
        return "conserved" if known.restitution == 1 else "Haff"

    def expected(self, time: Array, rows: Array, width: int) -> Array | None:
        """Of translation: what a bath holds, or Haff's law from the first sample on."""
        if not self.law() or not len(time):
            return None
        found, first = np.full((len(time), width), np.nan), rows[0, 0]
        if self.law() == "bath":
            found[:, 0] = self.theory.known.held
        else:
            haff = self.theory.haff_time(first)
            found[:, 0] = first * theory.haff_temperature(time - time[0], haff)
        return found

    def comparisons(self, time: Array, rows: Array) -> list[Comparison]:
        """The temperature at the end, and where it has fallen to a quarter, while the gas is still
        uniform; there also beside the collisions that there were."""
        if len(time) < 2:
            return []
        law, nan, name = self.expected(time, rows, 1), math.nan, self.law()
        known = nan if law is None else float(law[-1, 0])
        note, errors = self.note(), self.series.error()
        error = self.error(float(rows[-1, 0]), float(errors[-1, 0]))
        listed = [
            Comparison("temperature at the end", float(rows[-1, 0]), error, known, UNIT, note)
        ]
        if self.theory.known.turns:
            turning = float(rows[-1, 1])
            listed.append(
                Comparison("of rotation at the end", turning, float(errors[-1, 1]), unit=UNIT)
            )
        quarter = np.flatnonzero(rows[:, 0] <= 0.25 * rows[0, 0])
        if law is not None and name == "Haff" and len(quarter):
            k, e = quarter[0], self.theory.known.restitution
            found, at = float(rows[k, 0]), f"at t = {time[k]:.4g}"
            error, at = self.error(found, float(errors[k, 0])), f"temperature {at}"
            listed.append(Comparison(at, found, error, float(law[k, 0]), UNIT, note))
            # a sphere loses (1 - e^2)/d of its mean energy in each collision, in molecular chaos
            collisions = rows[k, 2] - rows[0, 2]
            if math.isnan(collisions):
                return listed
            lost = math.exp(-(1 - e**2) * collisions / self.case.box.dimension)
            what = f"temperature after {collisions:.3g} collisions of each"
            listed.append(Comparison(what, found, error, float(rows[0, 0]) * lost, UNIT, note))
        return listed

    def error(self, kT: float, of_runs: float) -> float:
        """Of a temperature: 0 where collisions keep it, what a bath leaves of Maxwell's velocities,
        else `of_runs`, by how runs scatter.

        In one run that cools by Haff's law it is that of as many independent velocities: measured
        with 637 disks of restitution 0.8, runs scatter by 0.7 of it at a quarter of the temperature
        and by all of it at a tenth.
        """
        known = self.theory.known
        degrees = self.case.box.dimension * max(self.case.particles - 1, 1)
        independent = math.sqrt(2 / (degrees * self.runs))
        if self.law() == "bath":
            averaged = not known.fluctuates or self.series.stride > 1
            return of_runs if averaged else float(known.held * independent)
        if self.law() == "conserved" and known.contact_time == 0 and not self.case.walls:
            return 0.0
        if self.law() == "Haff" and math.isnan(of_runs):
            return kT * independent
        return of_runs

    def note(self) -> str:
        """What the law leaves out."""
        if self.law() == "Haff":
            chaos = "approximate: molecular chaos, without clusters or pairs that meet again"
            single = np.isnan(self.series.error()).all()
            return f"{chaos}; {LOWER_BOUND}: as if velocities were independent" if single else chaos
        if self.law() == "conserved" and self.theory.known.contact_time > 0:
            return "approximate: contacts hold a part of the energy"
        return ""
