"""Collision rate of hard spheres."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.expected.enskog import pair_rate, root_of_temperature
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import CollidingSpheres
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result, joined
from mesokit.statistics import Blocks

MANY = 25  # collisions, of which blocks know the error
ENOUGH = 5  # to be expected, where none has been seen, for something to be compared
KINDS = ("pairs", "walls", "elastic by contact time")
NEIGHBOURS = "approximate: spheres that meet again, measured for disks at phi = 0.25"


@component
class CollisionRate(OfSpheres):
    """Collisions of a sphere per time: with others, with walls, and made elastic by a contact time.

    A collision of two counts for both; the effect of a contact time leaves out walls. The mean
    free path is the mean speed over the rate with others. Theory is that of a uniform gas of equal
    spheres with Maxwell's velocities: the rate that belongs to the pressure, at the temperature as
    it is in time.
    """

    quantity: Literal["collision-rate"] = tag("collision-rate")
    methods: ClassVar[tuple[str, ...]] = ("event-driven",)
    value_label = "collisions of a sphere per time"
    units: ClassVar[dict[str, str]] = {"value": "1/tau", "with": ""}


@accumulator_of(CollisionRate)
class CollisionRateAccumulator(BlockAccumulator):
    """Block averages of what has happened between two samples."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "before")

    def prepare(self) -> None:
        self.blocks = Blocks((5,))  # three rates, the root of the temperature, the mean speed
        self.before = np.full(6, np.nan)  # time, three counts, root of temperature, mean speed

    def observe(self, spheres: CollidingSpheres) -> None:
        """Take one sample: of what has happened since the last."""
        root = root_of_temperature(self.case, spheres.totals()[2])
        speed = float(np.linalg.norm(spheres.velocities(), axis=1).mean())
        now = np.array([spheres.time, *spheres.collisions, root, speed])
        elapsed = now[0] - self.before[0]
        if elapsed > 0:  # false at the first, which is nan
            pairs, walls, elastic = (now - self.before)[1:4] / elapsed / spheres.n
            between = 0.5 * (now[4:] + self.before[4:])
            self.blocks.add([2 * pairs, walls, 2 * elastic, *between])
        self.before = now

    def result(self) -> Result:
        """The three rates."""
        value, error, spheres = self.blocks.mean(), self.blocks.error(), self.case.spheres
        known = np.array([pair_rate(self.case, float(value[3])), math.nan, math.nan])
        contact_time, rare = spheres.collision.contact_time, ""
        if contact_time and not self.case.walls:
            known[2] = known[0] * theory.elastic_share(float(value[0]), contact_time)
            least, known[2], rare = self.of_few(float(value[2]), float(known[2]))
            error[2] = max(error[2], least)
        # that of a contact time counts walls as well, which are not counted apart
        shown = [0, 1] if self.case.walls else [0, 2] if contact_time else [0]
        drawn = 2 if self.case.walls else 1
        note = "" if spheres.collision.elastic else "approximate: molecular chaos"
        notes = [note, note, joined("" if math.isnan(known[2]) else NEIGHBOURS, rare)]

        def comparisons() -> Iterator[Comparison]:
            for k in shown:
                what = f"collisions per time, {KINDS[k]}"
                yield Comparison(what, value[k], error[k], known[k], "1/tau", notes[k])
            if value[0] > 0 and not self.case.walls:
                yield self.free_path(note)

        return self.report(
            {"with": KINDS[:drawn]},
            (value[:drawn], error[:drawn]),
            comparisons(),
            expected=known[:drawn],
            theory="Enskog",
        )

    def of_few(self, rate: float, known: float) -> tuple[float, float, str]:
        """The least error of a rate of few collisions, its theory, and a note.

        Of few collisions blocks do not give the error: it is Poisson's then, of as many as there
        are or are expected. Where none has been seen and few are, nothing can be compared.
        """
        spacing = self.observable.every * float(self.case.spheres.timestep)
        each = 2 / (self.case.particles * max(1, self.blocks.count) * spacing)  # rate of one
        seen, awaited = rate / each, known / each
        if max(seen, 0.0 if math.isnan(awaited) else awaited) >= MANY:
            return 0.0, known, ""
        text = f"{round(seen)} seen, {awaited:.2g} expected" if known >= 0 else f"{seen:.0f} seen"
        if seen < 0.5 and not awaited >= ENOUGH:
            return each, math.nan, f"{text}: the error is that of one"
        most = max(seen, awaited) if known >= 0 else seen
        return math.sqrt(most) * each, known, f"{text}: Poisson's error"

    def free_path(self, note: str) -> Comparison:
        """Mean speed over the rate, which Maxwell's velocities relate to one another."""
        found, d = of_mean(self.blocks), self.case.box.dimension
        rate, _, _, root, speed = found.value
        mass = self.case.spheres.kinds[0].mean_mass(d)
        maxwell = math.sqrt((math.pi / 2 if d == 2 else 8 / math.pi) / mass) * root
        gradient = np.array([-speed / rate**2, 0.0, 0.0, 0.0, 1 / rate])
        path, error = found.scalar(speed / rate, gradient)
        expected = maxwell / pair_rate(self.case, root)
        return Comparison("mean free path", path, error, expected, "a", note)
