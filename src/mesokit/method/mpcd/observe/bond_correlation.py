"""Correlation in time of the bonds of molecules, at rest and in shear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import free_bond
from mesokit.method.mpcd.expected.rheometer import shear_note, times_in_shear
from mesokit.method.mpcd.expected.selection import KIND, beads_of, molecule_of
from mesokit.observe.shared.origins import Origins
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import Observable, State, accumulator_of, pack, unpack
from mesokit.seam.result import Array, Comparison, Result


@component
class BondCorrelation(Observable):
    """<R_a(t) R_b(0)> of the bond vectors R of molecules, averaged over the bonds of each.

    In shear, where the flow along x carries bonds on, xy and yx differ: what lay along y turns
    towards x, not the other way round.
    """

    quantity: Literal["bond-correlation"] = tag("bond-correlation")
    needs_fluid: ClassVar[bool] = False
    molecules: int = param(500, doc="molecules followed", ge=1)
    kind: int | str = param(1, doc=KIND)
    max_lag: int = param(500, doc="longest lag", unit="steps", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules."""
        molecule_of(case, self.quantity, self.kind)


@accumulator_of(BondCorrelation)
class BondCorrelationAccumulator:
    """Bonds at many origins, for each pair of axes."""

    def __init__(self, observable: BondCorrelation, case: Case) -> None:
        molecule = molecule_of(case, observable.quantity, observable.kind)
        self.observable, self.case, self.name = observable, case, observable.label
        self.beads = beads_of(case, observable.molecules, observable.kind)
        self.ends = np.array(molecule.bonds)  # (bonds, 2)
        d, lags = case.box.dimension, max(1, observable.max_lag // observable.every)
        self.pairs = [(k, k) for k in range(d)]
        self.pairs += [(0, 1), (1, 0)] if case.box.sheared else []
        size = len(self.ends) * d
        self.origins = [Origins(len(self.beads), size, lags) for _ in self.pairs]

    def observe(self, fluid: RunningFluid) -> None:
        r = fluid.whole_positions(self.beads.ravel()).reshape(*self.beads.shape, -1)
        bonds = r[:, self.ends[:, 1]] - r[:, self.ends[:, 0]]
        shape = bonds.shape[1:]
        for (now, before), origins in zip(self.pairs, self.origins, strict=True):

            def product(old: Array, new: Array, now: int = now, before: int = before) -> Array:
                past, present = (x.reshape(-1, *shape) for x in (old, new))
                return np.asarray((present[:, :, now] * past[:, :, before]).mean(axis=1))

            origins.add(bonds.reshape(len(bonds), -1), product)

    def state(self) -> State:
        return pack(**dict(zip(self.names(), self.origins, strict=True)))

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        for name, origins in zip(self.names(), self.origins, strict=True):
            origins.restore(unpack(state, name))

    def pool(self, other: BondCorrelationAccumulator) -> None:
        """Take in the samples of an independent run of the same case: only to read."""
        for own, others in zip(self.origins, other.origins, strict=True):
            own.pool(others)

    def names(self) -> list[str]:
        """Of the pairs of axes, that of the later time first."""
        return ["xyz"[now] + "xyz"[before] for now, before in self.pairs]

    def result(self) -> Result:
        """The correlations, with theory."""
        every = [origins.estimate() for origins in self.origins]
        time = self.origins[0].sampled() * self.observable.every * self.case.fluid.timestep
        expected = self.expected(time)
        return Result(
            quantity="bond-correlation",
            name=self.name,
            x={"time": time, "component": np.array(self.names())},
            value=np.stack([one.value for one in every], axis=1),
            error=np.stack([one.error for one in every], axis=1),
            label="bond correlation",
            units={"value": "a^2", "time": "tau", "component": ""},
            expected=expected,
            theory="Rouse",
            comparisons=tuple(self.comparisons(every, expected)),
            samples=self.origins[0].count,
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
        return np.stack([getattr(found, name) for name in self.names()], axis=1)

    def comparisons(self, every: list[Estimate], expected: Array | None) -> list[Comparison]:
        """By which factor each curve differs from that of theory, by least squares."""
        if expected is None or not len(expected):
            return []
        found, note = [], shear_note(self.case)
        for name, one, line in zip(self.names(), every, expected.T, strict=True):
            weight = line / (line**2).sum()
            value, error = one.scalar(one.value @ weight, weight)
            found.append(Comparison(f"{name} over theory", value, error, 1.0, "", note))
        return found
