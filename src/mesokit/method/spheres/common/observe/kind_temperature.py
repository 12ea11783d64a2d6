"""Temperature of each kind of spheres, over that of all."""

from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class KindTemperature(OfSpheres):
    """Temperature of the motion of each kind over that of all: 1 of elastic spheres.

    Motion is about the mean velocity of all, whose degrees of freedom are left out. Kinds of an
    inelastic mixture keep different temperatures (Garzo and Dufty 1999).
    """

    quantity: Literal["kind-temperature"] = tag("kind-temperature")
    value_label = "temperature over that of all"
    units: ClassVar[dict[str, str]] = {"kind": ""}

    def check(self, case: Case) -> None:
        """Raise CaseError for a single kind, and for a kind without spheres."""
        counts = case.spheres.counts(case.box)
        if len(counts) < 2 or min(counts) < 1:
            raise CaseError("kind-temperature: expected two kinds of spheres or more")


@accumulator_of(KindTemperature)
class KindTemperatureAccumulator(BlockAccumulator):
    """Block averages of the ratios."""

    def prepare(self) -> None:
        counts = self.case.spheres.counts(self.case.box)
        self.kinds = np.repeat(np.arange(len(counts)), counts)  # spheres come kind after kind
        self.blocks = Blocks((len(counts),))

    def observe(self, spheres: RunningSpheres) -> None:
        """Take one sample; none of spheres that move as one."""
        m, v = spheres.masses(), spheres.velocities()
        energy = m * ((v - m @ v / m.sum()) ** 2).sum(axis=1)
        if energy.sum() == 0:
            return
        shares = np.bincount(self.kinds, energy) / energy.sum()
        # a sphere that has much of the mass has much of the mean velocity as well
        free = np.bincount(self.kinds, 1 - m / m.sum())
        self.blocks.add(shares * free.sum() / free)

    def result(self) -> Result:
        """One number for each kind; 1 where elastic collisions alone share out the energy."""
        value, error, section = self.blocks.mean(), self.blocks.error(), self.case.spheres
        collision, source = section.instant_collision, section.energy_source
        kicked = source is not None and source.white_noise
        alone = collision is not None and not self.case.walls
        known = alone and collision.elastic and not kicked
        expected = np.full(len(value), 1.0 if known else np.nan)
        names = [kind.name or str(k + 1) for k, kind in enumerate(section.kinds)]
        found = (
            Comparison(f"temperature of kind {name} over that of all", *numbers)
            for name, *numbers in zip(names, value, error, expected, strict=True)
        )
        theory = "equipartition" if known else ""
        return self.report({"kind": names}, self.blocks, found, expected=expected, theory=theory)
