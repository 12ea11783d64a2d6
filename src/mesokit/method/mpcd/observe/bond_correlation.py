"""Correlation in time of the bonds of molecules, at rest and in shear."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import free_bond
from mesokit.method.mpcd.expected.rheometer import shear_note, times_in_shear
from mesokit.method.mpcd.expected.selection import KIND, beads_of, molecule_of
from mesokit.observe.shared.origins import Origins
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result


@component
class BondCorrelation(Observable):
    """<R_a(t) R_b(0)> of the bond vectors R of molecules, averaged over the bonds of each.

    In shear, where the flow along x carries bonds on, xy and yx differ: what lay along y turns
    towards x, not the other way round.
    """

    quantity: Literal["bond-correlation"] = tag("bond-correlation")
    needs_fluid: ClassVar[bool] = False
    value_label = "bond correlation"
    units: ClassVar[dict[str, str]] = {"value": "a^2", "time": "tau", "component": ""}
    molecules: int = param(500, doc="molecules followed", ge=1)
    kind: int | str = param(1, doc=KIND)
    max_lag: int = param(500, doc="longest lag", unit="steps", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules."""
        molecule_of(case, self.quantity, self.kind)


@accumulator_of(BondCorrelation)
class BondCorrelationAccumulator(BlockAccumulator):
    """Bonds at many origins, for each pair of axes."""

    memory: ClassVar[tuple[str, ...]] = ("origins",)

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        molecule = molecule_of(case, observable.quantity, observable.kind)
        self.beads = beads_of(case, observable.molecules, observable.kind)
        self.ends = np.array(molecule.bonds)  # (bonds, 2)
        d, lags = case.box.dimension, max(1, observable.max_lag // observable.every)
        pairs = [(k, k) for k in range(d)] + ([(0, 1), (1, 0)] if case.box.sheared else [])
        size = len(self.ends) * d
        # by pairs of axes, that of the later time first
        self.origins = {
            AXES[now] + AXES[before]: Origins(len(self.beads), size, lags) for now, before in pairs
        }

    def observe(self, fluid: RunningFluid) -> None:
        r = fluid.whole_positions(self.beads.ravel()).reshape(*self.beads.shape, -1)
        bonds = r[:, self.ends[:, 1]] - r[:, self.ends[:, 0]]
        shape = bonds.shape[1:]
        for name, origins in self.origins.items():

            def product(old: Array, new: Array, name: str = name) -> Array:
                now, before = map(AXES.index, name)
                past, present = (x.reshape(-1, *shape) for x in (old, new))
                return np.asarray((present[:, :, now] * past[:, :, before]).mean(axis=1))

            origins.add(bonds.reshape(len(bonds), -1), product)

    def result(self) -> Result:
        every = [origins.estimate() for origins in self.origins.values()]
        first = next(iter(self.origins.values()))
        time = first.sampled() * self.observable.every * self.case.fluid.timestep
        expected = self.expected(time)
        return self.report(
            {"time": time, "component": list(self.origins)},
            every,
            self.comparisons(every, expected),
            expected=expected,
            theory="Rouse",
            samples=first.count,
        )

    def expected(self, time: Array) -> Array | None:
        """Of molecules of springs at rest, or in a steady shear whose temperature is held."""
        case, kind = self.case, self.observable.kind
        changing = case.box.sheared and not case.box.steady_rate
        if case.solutes is not None or case.walls or case.fluid.force.acts or changing:
            return None
        times, square = times_in_shear(case), free_bond(case, kind)
        if times is None or square is None or (case.box.sheared and not setting.isothermal(case)):
            return None
        found = theory.bond_correlation(
            time, times.stress, square, case.box.steady_rate, case.box.dimension, len(self.ends)
        )
        return np.stack([getattr(found, name) for name in self.origins], axis=1)

    def comparisons(self, every: list[Estimate], expected: Array | None) -> Iterator[Comparison]:
        if expected is None or not len(expected):
            return
        note = shear_note(self.case)
        for name, one, line in zip(self.origins, every, expected.T, strict=True):
            found = one.total(line / (line**2).sum())
            yield Comparison(f"{name} over theory", *found, 1.0, "", note)
