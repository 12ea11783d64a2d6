"""Density of spheres against their height in gravity."""

import math
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.spheres.common.observe.protocol import OfSpheres, gravity_axis
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

DILUTE = 0.005  # fraction at the floor above which an ideal gas is 1 % off, or more


@component
class HeightProfile(OfSpheres):
    """Number density of centres in layers above the floor, over the mean of the box.

    Gravity is along one axis, which plates close. Of elastic equal spheres the law of an ideal gas
    is beside it, at the temperature as measured.
    """

    quantity: Literal["height-profile"] = tag("height-profile")
    value_label = "density over that of the box"
    units: ClassVar[dict[str, str]] = {"height": "a"}
    bins: int = param(40, doc="layers from one plate to the other", ge=2, le=10_000)

    def check(self, case: Case) -> None:
        """Raise CaseError without gravity along one axis that plates close."""
        gravity_axis(case, "height-profile")


@accumulator_of(HeightProfile)
class HeightProfileAccumulator(BlockAccumulator):
    """Block averages of the layers, of the mean height and of the temperature."""

    def prepare(self) -> None:
        self.axis = gravity_axis(self.case, "height-profile")
        self.gravity = float(self.case.spheres.gravity[self.axis])
        self.depth = float(self.case.box.size[self.axis])
        self.edges = np.linspace(0.0, self.depth, self.observable.bins + 1)
        self.blocks = Blocks((self.observable.bins + 2,))

    def observe(self, spheres: RunningSpheres) -> None:
        place = spheres.positions(unwrapped=True)[:, self.axis]
        height = place if self.gravity < 0 else self.depth - place
        kT = 2 * spheres.totals()[2] / (spheres.dimension * spheres.n)
        shares = np.histogram(np.clip(height, 0, self.depth), self.edges)[0] / spheres.n
        self.blocks.add([*shares * (len(self.edges) - 1), height.mean(), kT])

    def result(self) -> Result:
        """The profile, and the mean height of centres."""
        value, error = self.blocks.mean(), self.blocks.error()
        expected, mean = self.expected(float(value[-1]))
        known = np.isfinite(mean)
        phi = self.case.spheres.fraction(self.case.box)
        dense = known and phi * float(np.nanmax(expected)) > DILUTE
        note = "approximate: ideal gas" if dense else ""
        return self.report(
            {"height": 0.5 * (self.edges[1:] + self.edges[:-1])},
            (value[:-2], error[:-2]),
            [Comparison("mean height", value[-2], error[-2], mean, "a", note)],
            expected=expected if known else None,
            theory="barometric law" if known else "",
            extra={"edges": self.edges.copy()},
        )

    def expected(self, kT: float) -> tuple[NDArray[np.float64], float]:
        """The profile and the mean height of an ideal gas; nan of what is no gas of this kind."""
        section, d = self.case.spheres, self.case.box.dimension
        kinds, collision = section.kinds, section.instant_collision
        alike = len(kinds) == 1 and kinds[0].spread == 0
        gas = collision is not None and collision.elastic and collision.hard
        if not alike or not gas or not kT > 0:
            return np.full(len(self.edges) - 1, math.nan), math.nan
        radius = 0.5 * kinds[0].diameter * section.scale(self.case.box)
        scale, free = kT / (kinds[0].mean_mass(d) * abs(self.gravity)), self.depth - 2 * radius
        shares = np.diff(theory.barometric_cdf(self.edges - radius, scale, free))
        return shares * (len(self.edges) - 1), radius + theory.barometric_mean(scale, free)
