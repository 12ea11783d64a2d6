"""Fourth cumulant: deviation of the velocities of spheres from Maxwell's distribution."""

from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.expected.velocities import Cumulant
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class VelocityCumulant(OfSpheres):
    """a_2 = d/(d + 2) <v^4>/<v^2>^2 - 1 of equal spheres: 0 of Maxwell's distribution.

    Each sample is scaled by its own temperature and freed of the mean velocity, and is corrected
    for their finite number: its mean is 0 for velocities drawn at random whatever the number.
    """

    quantity: Literal["velocity-cumulant"] = tag("velocity-cumulant")
    value_label = "fourth cumulant $a_2$"
    units: ClassVar[dict[str, str]] = {"of": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError where spheres differ in mass, and for less than three."""
        kinds = case.spheres.kinds
        if len(kinds) > 1 or kinds[0].spread:
            raise CaseError("velocity-cumulant: expected spheres of one kind, without spread")
        if case.particles < 3:
            raise CaseError(f"velocity-cumulant: {case.particles} spheres; expected 3 at least")


@accumulator_of(VelocityCumulant)
class VelocityCumulantAccumulator(BlockAccumulator):
    """Block averages of a_2."""

    def prepare(self) -> None:
        self.blocks = Blocks((1,))
        self.theory: Cumulant = method_of(self.case).expected["velocity-cumulant"](
            self.case, self.observable
        )

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample; none of spheres that stand still."""
        v = spheres.velocities()
        square = ((v - v.mean(axis=0)) ** 2).sum(axis=1)
        if square.mean() == 0:
            return
        d = spheres.dimension
        ratio = d / (d + 2) * float((square**2).mean() / square.mean() ** 2)
        # velocities of n spheres with a given sum and energy lie evenly on a sphere of so many
        # dimensions, on which the mean ratio is free/(free + 2)
        free = d * (spheres.n - 1)
        self.blocks.add([ratio * (free + 2) / free - 1])

    def result(self) -> Result:
        """One number."""
        theory, (value,), (error,) = self.theory, self.blocks.mean(), self.blocks.error()
        rough = theory.law and not theory.exact
        note = "approximate: first order, dilute uniform gas" if rough else ""
        return self.report(
            {"of": ["velocity"]},
            self.blocks,
            [Comparison("a_2", value, error, theory.value, "", note)],
            expected=np.array([theory.value]),
            theory=theory.law,
        )
