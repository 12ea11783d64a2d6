"""Static structure factor S(q), of all that is there or of single molecules."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.molecules import KIND, Group, free_bond, kind_of
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from mesokit.observe.shared.scatter_of_waves import scatter_of_waves
from mesokit.observe.shared.wave_vectors import CHUNK, amplitudes, reachable, wave_shells
from mesokit.observe.shared.whose import (
    OF,
    at_rest,
    default_of,
    groups_of,
    periodic_all_over,
    strangers,
)
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable
from mesokit.seam.result import Array, Comparison, Result

if TYPE_CHECKING:
    from mesokit.case.case import Case

LARGEST = 2 * math.pi  # wave number unless it is given: waves as long as a cell


@component
class StructureFactor(Observable):
    """<|sum_j e^(-i q r_j)|^2>/N over shells of the wave vectors that fit the box.

    Of chains N is the number of beads of one, and S(q)/N its form factor.
    """

    quantity: Literal["structure-factor"] = tag("structure-factor")
    needs_fluid: ClassVar[bool] = False
    of: Literal["beads", "particles", "chains"] | None = param(
        None, doc=f'{OF}; "chains": each molecule alone'
    )
    kind: int | str | None = param(None, doc=f"{KIND} (all unless said; of chains the first)")
    largest: float | None = param(
        None, doc="longest wave vector (2 pi, or less in a very large box)", unit="1/a", gt=0
    )
    shells: int = param(30, doc="of wave vectors of about one length", ge=1, le=1000)
    waves: int = param(6, doc="wave vectors of a shell at most, evenly spread", ge=1, le=10_000)
    molecules: int = param(500, doc="of chains, those looked at, evenly spread", ge=1)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules, without waves, and for waves that do not fit."""
        of = default_of(case, self.of)
        if of != "chains":
            periodic_all_over(case, f"structure-factor of {of}")
        groups = self.chosen(case)
        if of == "chains" and groups[0].length < 2:
            raise CaseError("of = 'chains': expected molecules of two beads or more")
        least, most = 2 * math.pi / max(case.box.size), reachable(case.box.size)
        if self.largest is not None and not least <= self.largest <= most:
            raise CaseError(
                f"largest = {self.largest:g}: expected {least:.4g} (one wave in the box) to "
                f"{most:.4g} (as many waves as can be listed)"
            )

    def chosen(self, case: Case) -> list[Group]:
        """Groups of molecules or particles."""
        of = default_of(case, self.of)
        if of == "chains":
            return groups_of(case, "beads", 1 if self.kind is None else self.kind)
        return groups_of(case, of, self.kind)

    def accumulator(self, case: Case) -> StructureFactorAccumulator:
        """An empty memory for it."""
        return StructureFactorAccumulator(self, case)


class StructureFactorAccumulator(BlockAccumulator):
    """Means of each shell; of chains also of groups of them, of others of each wave.

    Two error bars are kept, and the larger counts: long waves decay slowly, so that blocks of a
    short run see little of what they do; chains scatter, and so do waves of one length.
    """

    memory: ClassVar[tuple[str, ...]] = ("means", "sums")

    def __init__(self, observable: StructureFactor, case: Case) -> None:
        observable.check(case)
        self.name, self.case = observable.label, case
        self.of, self.groups = default_of(case, observable.of), observable.chosen(case)
        self.kind = observable.kind
        alone = self.of == "chains"
        self.beads = self.groups[0].beads(observable.molecules if alone else 0)
        largest = observable.largest or min(LARGEST, reachable(case.box.size))
        every = wave_shells(case.box.size, largest, observable.shells, observable.waves)
        self.waves = np.concatenate(every)
        self.starts = np.cumsum([0, *(len(shell) for shell in every[:-1])])
        self.members = np.array([len(shell) for shell in every])
        self.lengths = np.sqrt((self.waves**2).sum(axis=1))
        self.means = MeansOverMolecules(len(self.beads) if alone else 1, len(every))
        self.sums = np.zeros(len(self.waves))
        self.others: list[Array] = []  # means (waves,) of pooled runs

    def over_shells(self, each: Array) -> Array:
        """Means (..., shells) of what each wave vector (..., K) has."""
        return np.asarray(np.add.reduceat(each, self.starts, axis=-1) / self.members)

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        if self.of == "chains":
            beads = self.beads
            r = fluid.whole_positions(beads.ravel()).reshape(*beads.shape, -1)
            found, number = amplitudes(r, self.waves), beads.shape[1]
        else:
            found = self.altogether(fluid)[None]
            number = sum(group.number * group.length for group in self.groups)
        each = (found.real**2 + found.imag**2) / number
        self.sums += each.mean(axis=0)
        self.means.add(self.over_shells(each))

    def altogether(self, fluid: RunningFluid) -> NDArray[np.complex128]:
        """Sum of e^(-i q r) over all that are looked at, (K,)."""
        found = np.zeros(len(self.waves), complex)
        for group in self.groups:
            of_fluid = group.first < self.case.particles
            found += (self.of_particles if of_fluid else self.of_solutes)(fluid, group)
        return found

    def of_particles(self, fluid: RunningFluid, group: Group) -> NDArray[np.complex128]:
        """The same of a group in the fluid, whose kinds have a mass each."""
        found, start = np.zeros(len(self.waves), complex), 0
        first, last = group.first, group.first + group.number * group.length
        for kind in self.case.groups[0].kinds:
            own = max(first, start), min(last, start + kind.number)
            start += kind.number
            if own[0] < own[1]:
                found += fluid.modes(self.waves, *own)[0] / kind.mass
        return found

    def of_solutes(self, fluid: RunningFluid, group: Group) -> NDArray[np.complex128]:
        """The same of solutes, few enough to ask for all."""
        found, step = np.zeros(len(self.waves), complex), max(1, CHUNK // len(self.waves))
        r = fluid.positions(group.beads().ravel())
        for start in range(0, len(r), step):
            found += amplitudes(r[None, start : start + step], self.waves)[0]
        return found

    def pool(self, other: StructureFactorAccumulator) -> None:
        """Take in the samples of an independent run of the same case: only to read."""
        if not self.others:
            self.others = self.of_waves()
        self.others += other.of_waves()
        self.means.pool(other.means)

    def of_waves(self) -> list[Array]:
        """Means (waves,) of each run."""
        return self.others or [self.sums / max(self.means.blocks.count, 1)]

    def error(self) -> Array:
        """Standard error (shells,)."""
        found = self.means.error()
        if self.of == "chains" or not self.means.blocks.count:
            return found
        each = np.stack(self.of_waves())
        return np.fmax(found, scatter_of_waves(each, self.lengths, self.members))

    def result(self) -> Result:
        """S(q), beside Debye's sum or 1."""
        expected = self.expected()
        what = "chain" if self.of == "chains" else "all"
        bonded = max(group.length for group in self.groups) > 1
        return Result(
            quantity="structure-factor",
            drawing="structure factor",
            name=self.name,
            x={"q": self.over_shells(self.lengths)},
            value=self.means.mean(),
            error=self.error(),
            label="S(q) of one chain" if what == "chain" else "S(q)",
            units={"value": "", "q": "1/a"},
            expected=expected,
            theory="Debye" if bonded else "ideal gas",
            comparisons=tuple(self.comparisons(expected)),
            samples=self.means.blocks.count,
            extra={"waves": self.members},
        )

    def expected(self) -> Array | None:
        """That of one molecule on the average, where molecules do not know of one another."""
        kept = at_rest(self.case) and strangers(self.case, self.of, self.groups)
        if not kept:
            return None
        lengths, place = np.unique(np.round(self.lengths, 12), return_inverse=True)
        total, beads = np.zeros(len(lengths)), 0
        for group in self.groups:
            number = group.number * group.length
            beads, each = beads + number, self.of_one(group, lengths)
            if each is None:
                return None
            total += number * each
        return self.over_shells((total / beads)[place])

    def of_one(self, group: Group, lengths: Array) -> Array | None:
        """S(q) of one molecule of a group; None without a theory."""
        if group.molecule is None:
            return np.ones(len(lengths))
        bond = free_bond(self.case, kind_of(self.case, group))
        if bond is None:
            return None
        links, d = group.molecule.bonds, self.case.box.dimension
        return theory.gaussian_structure_factor(lengths, links, bond, d, group.length)

    def comparisons(self, expected: Array | None) -> list[Comparison]:
        """Longest waves; and by which factor all of it differs from theory, by least squares."""
        mean, error = self.means.mean(), self.error()
        if not self.means.blocks.count:
            return []
        q = f"at q = {self.over_shells(self.lengths)[0]:.4g}"
        known = np.nan if expected is None else float(expected[0])
        found = [
            Comparison("S of the longest waves", float(mean[0]), float(error[0]), known, note=q)
        ]
        if expected is not None:
            weight = (expected / (expected**2).sum())[None]
            value, bar = float(self.means.mean(weight)[0]), float(self.means.error(weight)[0])
            if self.of != "chains":  # shells are independent
                bar = max(bar, float(np.sqrt(((weight[0] * error) ** 2).sum())))
            found.append(Comparison("S(q) over theory", value, bar, 1.0))
        return found
