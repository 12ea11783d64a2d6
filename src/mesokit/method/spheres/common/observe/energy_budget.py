"""Energy of spheres in time: what they have, and what they have lost."""

import math
from collections.abc import Iterator, Mapping
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.component import component, tag
from mesokit.geometry import walls
from mesokit.method.spheres.common.observe.protocol import OfSpheres, Samples
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Array, Comparison, Result

HELD, LOSSES = ("translation", "rotation", "potential"), ("impact", "friction", "rolling")
UNIT = "m a^2/tau^2"


@component
class EnergyBudget(OfSpheres):
    """Kinetic energy of translation and of rotation, potential energy, and what is lost, in time.

    The potential energy is that of gravity and of contacts. Contact dynamics counts what impacts,
    friction and rolling take; of other methods the loss is what is missing since the first sample.
    """

    quantity: Literal["energy-budget"] = tag("energy-budget")
    drawing, value_label = "path", "energy"
    units: ClassVar[dict[str, str]] = {"value": UNIT, "time": "tau", "of": ""}


@accumulator_of(EnergyBudget)
class EnergyBudgetAccumulator(Samples):
    """Three energies and three losses in time, nan where they are not counted; `first` is the sum
    of all at the first sample, `books` that at the last."""

    memory: ClassVar[tuple[str, ...]] = ("series", "samples", "first", "books")
    width = len(HELD) + 1 + len(LOSSES)

    def prepare(self) -> None:
        super().prepare()
        self.first = self.books = math.nan

    def observe(self, spheres: RunningSpheres) -> None:
        energies = spheres.energies()
        counted: Mapping[str, float] | None = getattr(spheres, "lost", None)
        held, lost = [energies[name] for name in HELD], [math.nan] * len(LOSSES)
        if counted is not None:
            lost = [counted.get(name, 0.0) for name in LOSSES]
        total = math.fsum(held)
        self.books = total if counted is None else math.fsum([total, *counted.values()])
        if math.isnan(self.first):
            self.first = self.books
        # what is counted, else what is missing
        gone = self.first - total if counted is None else math.fsum(counted.values())
        self.series.add(spheres.time, [*held, gone, *lost])
        self.samples += 1

    def result(self) -> Result:
        """The series, with error bars where four runs or more are pooled."""
        time, rows, errors = self.series.time(), self.series.values(), self.series.error()
        counted = bool(np.isfinite(rows[:, 4:]).any())
        columns, names = [0, 1, 2, 3], [*HELD, "lost"]
        if counted:
            columns, names = [0, 1, 2, 4, 5, 6], [*HELD, *(f"lost to {name}" for name in LOSSES)]
        return self.report(
            {"time": time, "of": names},
            (rows[:, columns], errors[:, columns]),
            self.comparisons(rows, errors, counted),
            samples=self.samples,
        )

    def comparisons(self, rows: Array, errors: Array, counted: bool) -> Iterator[Comparison]:
        """Energies at the end, losses, and whether the books close."""
        if not len(rows):
            return
        end, error = rows[-1], errors[-1]
        for k, name in enumerate(HELD):
            yield Comparison(f"energy of {name} at the end", end[k], error[k], unit=UNIT)
        work = self.work()
        known = 0.0 if self.conserved() and not work else math.nan
        yield Comparison("energy lost", end[3], error[3], known, UNIT, work)
        if not counted:
            return
        for k, name in enumerate(LOSSES, 4):
            yield Comparison(f"energy lost to {name}", end[k], error[k], unit=UNIT)
        if self.first and not work:
            what = "energy with losses over that at first"
            yield Comparison(what, self.books / self.first, 0.0, 1.0)

    def work(self) -> str:
        """A note if walls, shear or a bath do work, which no method counts."""
        case, section = self.case, self.case.spheres
        surfaces = [surface for _, surface, _ in walls.surfaces(case)]
        contacts = [surface.contact for surface in surfaces if surface.contact is not None]
        moves = any(surface.moves for surface in surfaces)
        moves |= any(c.amplitude > 0 or c.temperature is not None for c in contacts)
        moves |= any(c.drives for c in contacts)
        if moves or any(surface.rule == "diffuse" for surface in surfaces):
            return "less the work of walls"
        if case.box.sheared:
            return "less the work of the shear of the box"
        heated = section.energy_source is not None or section.thermostatted
        return "less the work of a bath" if heated else ""

    def conserved(self) -> bool:
        """Whether collisions that take no time keep all energy."""
        rule = self.case.spheres.instant_collision
        surfaces = [surface for _, surface, _ in walls.surfaces(self.case)]
        lossy = any(
            c.restitution not in (None, 1.0) or c.tangential not in (None, -1.0, 1.0) or c.friction
            for c in (surface.contact for surface in surfaces)
            if c is not None
        )
        return rule is not None and rule.elastic and not lossy
