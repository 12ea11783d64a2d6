"""Pressure and collision rate of hard spheres."""

import math
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.expected.enskog import compressibility, equal_hard, speed_factor
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import CollidingSpheres
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class EquationOfState(OfSpheres):
    """Z = P/(n kT) of spheres that keep energy, by the virial and, of hard ones, by the rate.

    By the virial Z = 1 + sum of r.dp over collisions/(d N kT t), where d (N - 1) kT is twice the
    kinetic energy, as the momentum is zero. Hard spheres of one size collide at a rate that says
    the same (Enskog): (Z - 1) 2 d/(diameter sqrt(pi m/kT)). Spheres with wells or shoulders have
    the virial alone, and no theory.
    """

    quantity: Literal["equation-of-state"] = tag("equation-of-state")
    methods: ClassVar[tuple[str, ...]] = ("event-driven",)
    value_label = "compressibility $P/(n k_B T)$"
    units: ClassVar[dict[str, str]] = {"measured by": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError where there is no pressure of a uniform fluid."""
        if case.walls or case.spheres.gravity:
            raise CaseError("equation-of-state: not with walls or gravity")
        if not case.spheres.collision.elastic:
            raise CaseError("equation-of-state: expected collisions that keep energy")
        if case.particles < 2:
            raise CaseError("equation-of-state: one sphere meets none; expected two or more")


@accumulator_of(EquationOfState)
class EquationOfStateAccumulator(BlockAccumulator):
    """Block averages of what collisions do between two samples."""

    memory: ClassVar[tuple[str, ...]] = ("blocks", "before")

    def prepare(self) -> None:
        self.blocks = Blocks((3,))  # virial and collisions per time, twice the kinetic energy
        self.before = np.full(3, np.nan)  # time, virial, collisions at the last sample

    def observe(self, spheres: CollidingSpheres) -> None:
        """Take one sample: of what has happened since the last."""
        now = np.array([spheres.time, spheres.virial, spheres.collisions[0]])
        if np.isfinite(self.before[0]) and now[0] > self.before[0]:
            rates = (now[1:] - self.before[1:]) / (now[0] - self.before[0])
            self.blocks.add([*rates, 2 * spheres.totals()[2]])
        self.before = now

    def result(self) -> Result:
        """Z by the virial and, of equal hard spheres, by the rate of collisions."""
        pressures, rate = self.measured()
        expected, law, note = compressibility(self.case)
        names = ["virial", "collision rate"][: len(pressures)]
        if self.blocks.count and rate[0] == 0:
            note = "undetermined: no collision was seen"

        def comparisons() -> Iterator[Comparison]:
            for name, found in zip(names, pressures, strict=True):
                yield Comparison(f"Z by the {name}", *found, expected, "", note)
            yield Comparison("collision rate", *rate, self.expected_rate(expected), "1/tau", note)

        values, errors = np.transpose(pressures)
        return self.report(
            {"measured by": names},
            (values, errors),
            comparisons(),
            expected=np.full(len(names), expected),
            theory=law,
            extra={"packing_fraction": self.case.spheres.fraction(self.case.box)},
        )

    def measured(self) -> tuple[list[tuple[float, float]], tuple[float, float]]:
        """Z with its error by each way, and the collisions of a sphere per time."""
        case, n, d = self.case, self.case.particles, self.case.box.dimension
        undetermined = [(math.nan, math.nan)] * (2 if equal_hard(self.case) else 1)
        if not self.blocks.count:
            return undetermined, (math.nan, math.nan)
        found = of_mean(self.blocks)
        virial, events, twice = found.value
        if not events:  # none of these numbers is known then
            return undetermined, (0.0, math.nan)
        kT = twice / (d * (n - 1))  # momentum is zero
        gradient = np.array([1 / (d * n * kT), 0.0, -virial / (d * n * kT * twice)])
        pressures = [found.scalar(1 + virial / (d * n * kT), gradient)]
        if len(undetermined) == 2:
            kind, scale = case.spheres.kinds[0], case.spheres.scale(case.box)
            factor = kind.diameter * scale * math.sqrt(math.pi * kind.mean_mass(d) / kT)
            factor *= 2 / n / (2 * d) / speed_factor(case)
            gradient = np.array([0.0, factor, -0.5 * factor * events / twice])
            pressures.append(found.scalar(1 + factor * events, gradient))
        return pressures, found.scalar(2 * events / n, np.array([0.0, 2 / n, 0.0]))

    def expected_rate(self, z: float) -> float:
        """Collisions of a sphere per time that belong to Z, nan for mixtures."""
        if not equal_hard(self.case):
            return math.nan
        case, d = self.case, self.case.box.dimension
        kind = case.spheres.kinds[0]
        diameter = kind.diameter * case.spheres.scale(case.box)
        kT = self.blocks.mean()[2] / (d * (case.particles - 1))
        excess = (z - 1) * speed_factor(case)
        return float(2 * d * excess / (diameter * math.sqrt(math.pi * kind.mean_mass(d) / kT)))
