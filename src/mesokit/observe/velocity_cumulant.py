"""How far the velocities of spheres are from Maxwell's: the fourth cumulant."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.observe.shared.protocol import BlockAccumulator, Observable
from mesokit.observe.shared.result import Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.engine import RunningSpheres


@component
class VelocityCumulant(Observable):
    """a_2 = d/(d + 2) <v^4>/<v^2>^2 - 1 of equal spheres: 0 of Maxwell's distribution.

    Each sample is scaled by its own temperature and freed of the mean velocity, and is corrected
    for their finite number: its mean is 0 for velocities drawn at random whatever the number.
    """

    quantity: Literal["velocity-cumulant"] = tag("velocity-cumulant")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    needs_fluid: ClassVar[bool] = False

    def check(self, case: Case) -> None:
        """Raise CaseError where spheres differ in mass, and for less than three."""
        kinds = case.spheres.kinds
        if len(kinds) > 1 or kinds[0].spread:
            raise CaseError("velocity-cumulant: expected spheres of one kind, without spread")
        if case.particles < 3:
            raise CaseError(f"velocity-cumulant: {case.particles} spheres; expected 3 at least")

    def accumulator(self, case: Case) -> VelocityCumulantAccumulator:
        """An empty memory for it."""
        return VelocityCumulantAccumulator(self, case)


class VelocityCumulantAccumulator(BlockAccumulator):
    """Block averages of a_2."""

    def __init__(self, observable: VelocityCumulant, case: Case) -> None:
        observable.check(case)
        self.name, self.case, self.blocks = observable.label, case, Blocks((1,))

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
        value, error = self.blocks.mean(), self.blocks.error()
        known, law = self.expected()
        inexact = law == "van Noije and Ernst"
        note = "approximate: first order, dilute uniform gas" if inexact else ""
        listed = (Comparison("a_2", float(value[0]), float(error[0]), known, "", note),)
        return Result(
            quantity="velocity-cumulant",
            drawing="curve",
            name=self.name,
            x={"of": np.array(["velocity"])},
            value=value,
            error=error,
            label="fourth cumulant $a_2$",
            units={"value": "", "of": ""},
            expected=np.array([known]),
            theory=law,
            comparisons=listed if self.blocks.count else (),
            samples=self.blocks.count,
        )

    def expected(self) -> tuple[float, str]:
        """What theory knows: of elastic spheres, and of smooth ones of constant restitution."""
        section = self.case.spheres
        if self.case.walls:
            return math.nan, ""
        if (collision := getattr(section, "collision", None)) is None:
            keeps_energy = getattr(section.pair, "elastic", True)  # a potential does
            return (0.0, "Maxwell") if keeps_energy else (math.nan, "")
        if collision.elastic:
            return 0.0, "Maxwell"
        heating = self.case.spheres.heating
        kicked = hasattr(heating, "power")  # a white noise, unlike a bath
        constant = hasattr(collision, "restitution") and collision.reach == 1
        if not constant or collision.rough or collision.contact_time or (heating and not kicked):
            return math.nan, ""
        d = self.case.box.dimension
        known = theory.fourth_cumulant(collision.restitution, d, heated=kicked)
        return known, "van Noije and Ernst"
