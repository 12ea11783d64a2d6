"""Stress and contacts of soft spheres."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.method.spheres.soft.pair.protocol import ContactLaw
from mesokit.seam.estimate import of_mean
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import NOT_STEADY, Comparison, Result, joined
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.spheres.soft.engine.engine import SoftEngine

PARTS = ("motion", "forces")
LANDED = 0.1  # of the weight: a bed whose flux is nearer to it has landed


@component
class ContactStress(OfSpheres):
    """Pressure by the motion of soft spheres and by their forces, and how many touch each.

    The pressure of forces is the virial of pairs, sum r F over d times the volume of the box.
    The pressure of stiff elastic spheres in a box without walls is compared with that of hard ones.
    In a bed the momentum flux along gravity, over the box, carries the weight above each height: it
    is m g times the sum of the heights above those of spheres on the floor. That holds as long as
    none is thrown against the ceiling.
    """

    quantity: Literal["contact-stress"] = tag("contact-stress")
    methods: ClassVar[tuple[str, ...]] = ("soft-spheres",)
    value_label = "pressure"
    units: ClassVar[dict[str, str]] = {"by": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError for one sphere."""
        if case.particles < 2:
            raise CaseError("1 sphere; expected 2 at least")


@accumulator_of(ContactStress)
class ContactStressAccumulator(BlockAccumulator):
    """Block averages of pressures, temperature, contacts, and flux and weight along gravity."""

    def prepare(self) -> None:
        case = self.case
        self.volume = float(np.prod(case.box.size))
        self.floor = _floor(case)
        self.unit = "m/tau^2" if case.box.dimension == 2 else "m/(a tau^2)"
        self.blocks = Blocks((7,))

    def observe(self, spheres: SoftEngine) -> None:
        d, stress = spheres.dimension, spheres.stress
        pressures = [-float(np.trace(stress[name])) / d for name in ("kinetic", "pair")]
        still = 0 if self.case.walls else 1  # without walls the momentum is zero
        kT = 2 * spheres.totals()[2] / (d * max(spheres.n - still, 1))
        flux = weight = above = 0.0
        if self.floor is not None:
            k, g, base = self.floor
            flux = -float(stress["kinetic"][k, k] + stress["pair"][k, k]) * self.volume
            height = (spheres.positions(unwrapped=True)[:, k] - base) * math.copysign(1.0, -g)
            lowest = 0.5 * spheres.diameters()
            weight = abs(g) * float(spheres.masses() @ (height - lowest.mean()))
            above = float((height + lowest > self.case.box.size[k]).any())
        self.blocks.add([*pressures, kT, spheres.coordination().mean(), flux, weight, above])

    def result(self) -> Result:
        """Pressures, and what they are to be."""
        value, error = self.blocks.mean(), self.blocks.error()
        return self.report(
            {"by": PARTS}, (value[:2], error[:2]), self.comparisons(), units={"value": self.unit}
        )

    def comparisons(self) -> Iterator[Comparison]:
        """Pressure, compressibility, contacts, and flux over weight."""
        found, section, box = of_mean(self.blocks), self.case.spheres, self.case.box
        kinetic, forces, kT, contacts, flux, weight, above = found.value
        alike = len(section.kinds) == 1 and section.kinds[0].spread == 0
        total = found.scalar(kinetic + forces, np.array([1.0, 1, 0, 0, 0, 0, 0]))
        yield Comparison("pressure", *total, unit=self.unit)
        if self.floor is None and not self.case.walls and kT > 0:
            per, known, note = 1 / (self.case.particles / self.volume * kT), math.nan, ""
            gradient = np.array([0.0, per, -forces * per / kT, 0, 0, 0, 0])
            elastic = isinstance(section.pair, ContactLaw) and section.pair.elastic
            if alike and elastic and not section.gravity:
                known = theory.compressibility(section.fraction(box), box.dimension)
                note = "approximate: hard spheres"
            measured = found.scalar(1 + forces * per, gradient)
            yield Comparison("P/(n kT)", *measured, known, "", note)
        if isinstance(section.pair, ContactLaw):
            yield Comparison("contacts of a sphere", *found.scalar(contacts, np.eye(7)[3]))
        if self.floor is not None and weight > 0 and above == 0:
            gradient = np.array([0.0, 0, 0, 0, 1 / weight, -flux / weight**2, 0])
            ratio, error = found.scalar(flux / weight, gradient)
            off = "lie on the floor without overlap" if alike else "on the floor have the mean size"
            note = joined(self.falling(ratio), f"approximate: as if spheres {off}")
            yield Comparison("flux along gravity over weight", ratio, error, 1.0, "", note)

    def falling(self, ratio: float) -> str:
        """A note if samples began while spheres fell, and the flux is not yet near the weight."""
        assert self.floor is not None
        k, g, _ = self.floor
        step, had = method_of(self.case).timestep(self.case), self.case.run.warmup
        need = math.ceil(2 * math.sqrt(2 * self.case.box.size[k] / abs(g)) / step)
        if had >= need or abs(ratio - 1) < LANDED:
            return ""
        return f"{NOT_STEADY}: a fall and a rise take {need} steps before samples, had {had}"


def _floor(case: Case) -> tuple[int, float, float] | None:
    """The axis of gravity, its acceleration and the place of the plate below; None without."""
    pulls = [(k, g) for k, g in enumerate(case.spheres.gravity) if g]
    if len(pulls) != 1:
        return None
    k, g = pulls[0]
    if not any(case.box.axes[k] in wall.closed_axes for wall in case.walls):
        return None
    return k, g, 0.0 if g < 0 else float(case.box.size[k])
