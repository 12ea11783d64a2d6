"""Static structure factor S(q), of all that is there or of single molecules."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.molecules import free_bond
from mesokit.method.mpcd.expected.selection import (
    KIND,
    Group,
    default_of,
    groups_of,
    independent,
    kind_of,
)
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from mesokit.observe.shared.periodic import OF, periodic_all_over
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import spread_ids

LARGEST = 2 * math.pi  # wave number unless it is given: waves as long as a cell
MOST = 2**20  # wave vectors of which shells are made
CHUNK = 2**20  # phases at once
FEWEST = 12  # degrees of freedom that the scatter of waves is taken from
CURVE = 2  # degree of the polynomial that S is taken for where they are


@component
class StructureFactor(Observable):
    """<|sum_j e^(-i q r_j)|^2>/N over shells of the wave vectors that fit the box.

    Of chains N is the number of beads of one, and S(q)/N its form factor.
    """

    quantity: Literal["structure-factor"] = tag("structure-factor")
    needs_fluid: ClassVar[bool] = False
    drawing = "structure factor"
    units: ClassVar[dict[str, str]] = {"q": "1/a"}
    of: Literal["beads", "particles", "bodies", "chains"] | None = param(
        None, doc=f'{OF}; "bodies": their centres; "chains": each molecule alone'
    )
    kind: int | str | None = param(
        None, doc=f"{KIND}; or which of bodies (all unless said; of chains the first)"
    )
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
        of = default_of(case, self.of)
        if of == "chains":
            return groups_of(case, "beads", 1 if self.kind is None else self.kind)
        return groups_of(case, of, self.kind)


@accumulator_of(StructureFactor)
class StructureFactorAccumulator(BlockAccumulator):
    """Means of each shell; of chains also of groups of them, of others of each wave.

    Two error bars are kept, and the larger counts: long waves decay slowly, so that blocks of a
    short run see little of what they do; chains scatter, and so do waves of one length.
    """

    memory: ClassVar[tuple[str, ...]] = ("means", "sums")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
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
        if self.of == "chains":
            beads = self.beads
            r = fluid.whole_positions(beads.ravel()).reshape(*beads.shape, -1)
            found, number = wave_sums(r, self.waves), beads.shape[1]
        else:
            found = self.altogether(fluid)[None]
            number = sum(group.number * group.length for group in self.groups)
        each = (found.real**2 + found.imag**2) / number
        self.sums += each.mean(axis=0)
        self.means.add(self.over_shells(each))

    def altogether(self, fluid: RunningFluid) -> NDArray[np.complex128]:
        """Sum of e^(-i q r) over all that are looked at, (K,)."""
        found, step = np.zeros(len(self.waves), complex), max(1, CHUNK // len(self.waves))
        for group in self.groups:
            first, last = group.first, group.first + group.number * group.length
            if first >= self.case.particles:  # solutes and bodies, few enough to read all
                r = fluid.positions(group.beads().ravel())
                pieces = (r[None, start : start + step] for start in range(0, len(r), step))
                of_group = sum(wave_sums(piece, self.waves)[0] for piece in pieces)
            else:
                of_group, start = np.zeros(len(self.waves), complex), 0
                for kind in self.case.groups[0].kinds:  # each has a mass
                    own = max(first, start), min(last, start + kind.number)
                    start += kind.number
                    if own[0] < own[1]:
                        of_group += fluid.modes(self.waves, *own)[0] / kind.mass
            found += of_group
        return found

    def pool(self, other: StructureFactorAccumulator) -> None:
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
        expected = self.expected()
        bonded = max(group.length for group in self.groups) > 1
        return self.report(
            {"q": self.over_shells(self.lengths)},
            (self.means.mean(), self.error()),
            self.comparisons(expected),
            label="S(q) of one molecule" if self.of == "chains" else "S(q)",
            expected=expected,
            theory="Debye" if bonded else "ideal gas",
            samples=self.means.blocks.count,
            extra={"waves": self.members},
        )

    def expected(self) -> Array | None:
        """That of one molecule on average, where molecules are independent."""
        if not independent(self.case, self.of, self.groups):
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

    def comparisons(self, expected: Array | None) -> Iterator[Comparison]:
        mean, error = self.means.mean(), self.error()
        q = f"at q = {self.over_shells(self.lengths)[0]:.4g}"
        known = np.nan if expected is None else expected[0]
        yield Comparison("S of the longest waves", mean[0], error[0], known, note=q)
        if expected is not None:
            weight = expected / (expected**2).sum()
            value, bar = self.means.total(weight)
            if self.of != "chains":  # shells are independent
                bar = max(bar, float(np.sqrt(((weight * error) ** 2).sum())))
            yield Comparison("S(q) over theory", value, bar, 1.0)


def reachable(size: Sequence[float]) -> float:
    """The length of a wave vector up to which there are MOST in a box."""
    d = len(size)
    ball = math.pi if d == 2 else 4.0 / 3.0 * math.pi
    each = math.prod(2 * math.pi / length for length in size)
    return float((2 * MOST * each / ball) ** (1 / d))


def wave_shells(size: Sequence[float], largest: float, shells: int, most: int) -> list[Array]:
    """Wave vectors (K, d) of each of so many shells of equal width, but for those that are empty.

    Of q and -q there is one. At most so many in a shell, evenly spread over all.

    >>> [len(shell) for shell in wave_shells([10, 10], 1.0, 3, 50)]  # 0.63; 0.89
    [2, 2]
    """
    longest = [int(largest * length / (2 * math.pi)) for length in size]
    axes = [np.arange(0 if k == 0 else -n, n + 1) for k, n in enumerate(longest)]
    whole = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(size))
    chosen, zero = np.zeros(len(whole), bool), np.ones(len(whole), bool)
    for along in whole.T:  # those whose first component that is not 0 is above 0
        chosen |= zero & (along > 0)
        zero &= along == 0
    whole = whole[chosen]
    vectors = 2 * np.pi * whole / np.array(size, float)
    length = np.sqrt((vectors**2).sum(axis=1))
    place = np.ceil(length / largest * shells - 1e-9).astype(int) - 1
    order = np.argsort(place, kind="stable")
    bounds = np.searchsorted(place[order], np.arange(shells + 1))
    members = (order[low:high] for low, high in itertools.pairwise(bounds))
    return [vectors[one[spread_ids(most, len(one))]] for one in members if len(one)]


def wave_sums(r: Array, waves: Array) -> NDArray[np.complex128]:
    """Sum over the beads of e^(-i q r), (molecules, K), of molecules (molecules, length, d)."""
    found = np.empty((len(r), len(waves)), complex)
    step = max(1, CHUNK // (r.shape[1] * len(waves)))
    for start in range(0, len(r), step):
        phase, here = r[start : start + step] @ waves.T, slice(start, start + step)
        found.real[here] = np.cos(phase).sum(axis=1)  # in half the time of a complex exponential
        found.imag[here] = -np.sin(phase).sum(axis=1)
    return found


def scatter_of_waves(each: Array, lengths: Array, members: NDArray[np.int64]) -> Array:
    """Standard error (shells,) of the mean over the waves of each shell; nan of too few waves.

    Waves are independent of one another, and neighbours scatter alike about S, a smooth function
    of q: by all of it if a run is short against the time in which they decay.

    Parameters: means `each` (runs, waves) over the time of each run; `lengths` (waves,) of the
    waves, shell by shell; `members` (shells,), how many are in each.

    >>> rng = np.random.default_rng(1)
    >>> lengths = np.repeat([1.0, 2.0, 3.0], 400)
    >>> once = rng.exponential(size=(1, 1200))  # as |rho|^2 of a single sample is
    >>> error = scatter_of_waves(once, lengths, np.array([400, 400, 400]))
    >>> bool(np.all(abs(error * 400**0.5 - 1) < 0.25))
    True
    """
    ends, (runs, _) = np.cumsum(members), each.shape
    starts, last = ends - members, len(members) - 1
    found = np.full(len(members), np.nan)
    # Shell by shell: neighbours on both sides are added until there are enough degrees of freedom.
    # A polynomial in q takes the trend of S away before.
    for place in range(len(members)):
        for reach in range(len(members)):
            low, high = max(0, place - reach), min(last, place + reach)
            near = slice(int(starts[low]), int(ends[high]))
            known = len(np.unique(np.round(lengths[near], 9)))
            degree = min(CURVE, known - 1)
            freedom = runs * (near.stop - near.start) - degree - 1
            if freedom >= FEWEST:
                q = lengths[near]
                powers = np.vander((q - q.mean()) / q.mean(), degree + 1)
                trend = np.linalg.lstsq(powers, each[:, near].mean(axis=0), rcond=None)[0]
                away = each[:, near] - powers @ trend
                variance = (away**2).sum() / freedom
                found[place] = np.sqrt(variance / (members[place] * runs))
                break
    return found
