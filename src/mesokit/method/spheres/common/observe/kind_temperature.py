"""Temperature of each kind of spheres, over that of all."""

from typing import ClassVar, Literal

import numpy as np

from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.errors import CaseError
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks


@component
class KindTemperature(Observable):
    """Temperature of the motion of each kind over that of all: 1 of elastic spheres.

    Motion is about the mean velocity of all, whose degrees of freedom are left out. Kinds of an
    inelastic mixture keep different temperatures (Garzo and Dufty 1999).
    """

    quantity: Literal["kind-temperature"] = tag("kind-temperature")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    of_methods_alone: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False

    def check(self, case: Case) -> None:
        """Raise CaseError for a single kind, and for a kind without spheres."""
        counts = case.spheres.counts(case.box)
        if len(counts) < 2 or min(counts) < 1:
            raise CaseError("kind-temperature: expected two kinds of spheres or more")


@accumulator_of(KindTemperature)
class KindTemperatureAccumulator(BlockAccumulator):
    """Block averages of the ratios."""

    def __init__(self, observable: KindTemperature, case: Case) -> None:
        self.name, self.case = observable.label, case
        counts = case.spheres.counts(case.box)
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
        """One number for each kind."""
        value, error = self.blocks.mean(), self.blocks.error()
        known = self.shared_out()
        expected = np.full(len(value), 1.0 if known else np.nan)
        names = [kind.name or str(k + 1) for k, kind in enumerate(self.case.spheres.kinds)]
        listed = tuple(
            Comparison(
                f"temperature of kind {names[k]} over that of all",
                float(value[k]),
                float(error[k]),
                float(expected[k]),
                "",
            )
            for k in range(len(names))
        )
        return Result(
            quantity="kind-temperature",
            drawing="curve",
            name=self.name,
            x={"kind": np.array(names)},
            value=value,
            error=error,
            label="temperature over that of all",
            units={"value": "", "kind": ""},
            expected=expected,
            theory="equipartition" if known else "",
            comparisons=listed if self.blocks.count else (),
            samples=self.blocks.count,
        )

    def shared_out(self) -> bool:
        """Whether collisions alone share out the energy: elastic ones, without walls or kicks."""
        section = self.case.spheres
        collision, source = section.instant_collision, section.energy_source
        if collision is None or self.case.walls:
            return False
        return collision.elastic and not (source is not None and source.white_noise)
