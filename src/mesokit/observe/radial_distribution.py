"""Radial distribution function g(r): how many others there are at a distance."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator

from mesokit.case.case import Case
from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.observe.shared.of_method import OfMethod
from mesokit.observe.shared.pairs import OwnPairs, count_pairs, count_within, shells
from mesokit.observe.shared.periodic import OF, periodic_all_over
from mesokit.observe.shared.short_run import of_relaxations
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined
from mesokit.statistics import Blocks

Ids = NDArray[np.int64]
FARTHEST = 5.0  # unless a reach is given
ENOUGH = 100.0  # times of diffusion over the reach, for error bars
ROUNDING = 1e-12
BEYOND, SHELLS = 1.1, 5  # contact diameters to which shells reach, and their number


class Group(Protocol):
    """Molecules of one kind: the number of their first particle, particles of a molecule,
    molecules."""

    @property
    def first(self) -> int: ...
    @property
    def length(self) -> int: ...
    @property
    def number(self) -> int: ...
    def beads(self, wanted: int | None = None) -> Ids: ...


class Neighbours(Protocol):
    """Theory of neighbours by a method.

    It is made of a case and the observable, and raises CaseError where there are none. Pairs are
    those of groups `first` with `second`, or without these those within `first`. `size` is that of
    the largest particles. Of equal hard spheres `diameter` is where they touch, `value` g there,
    both nan if not known, and `note` what to say of it. What is not overridden holds for particles
    that interact and are all looked at.
    """

    first: list[Group]
    second: list[Group]
    size: float
    diameter: float
    value: float
    note: str

    def sampled(self, group: Group) -> bool:
        """True if some molecules of a group are looked at, others at each sample."""
        return False

    def independent(self, groups: list[Group]) -> bool:
        """True if molecules are independent of all others."""
        return False

    def diffusion(self, group: Group) -> float | None:
        """Diffusion coefficient of the molecules of a group, None if not known."""
        return None


@component
class RadialDistribution(OfMethod):
    """Pairs at a distance r over those of as many independent particles, in a periodic box.

    Of a fluid some particles are looked at, which changes the error bars and not the mean; of
    solutes all beads, of bodies all centres, and of other methods all spheres. g at contact of
    equal hard spheres is extrapolated from shells just beyond it.
    """

    quantity: Literal["radial-distribution"] = tag("radial-distribution")
    value_label = "g(r)"
    units: ClassVar[dict[str, str]] = {"r": "a"}
    needs_fluid: ClassVar[bool] = False
    of: Literal["beads", "particles", "bodies"] | None = param(None, doc=OF)
    kinds: Many[int | str] = param(
        (),
        doc="one kind, or two: those of the second about one of the first (all unless said); names "
        "or numbers from 1, of solutes.polymers, fluid.species, bodies or spheres.kinds; 'fluid': "
        "its molecules",
        max_length=2,
    )
    pairs: Literal["all", "between"] = param(
        "all", doc='"between": only those of different molecules'
    )
    reach: float | None = param(
        None,
        doc="longest distance (half of the shortest side unless said; of fluids 5 at most, of "
        "bodies and spheres 5 of the largest diameter)",
        unit="a",
        gt=0,
    )
    bins: int = param(50, doc="bins of the distance", ge=1, le=10_000)
    particles: int = param(400, doc="of the fluid, those looked at, others at each sample", ge=2)

    @field_validator("of", mode="before")
    @classmethod
    def _no_kind(cls, of: Any) -> Any:
        if isinstance(of, str) and of not in ("beads", "particles", "bodies"):
            known = "expected 'beads', 'particles' or 'bodies'"
            raise ValueError(f"{known}; kinds are chosen by `kinds`")
        return of

    def check(self, case: Case) -> None:
        """Raise CaseError in a box that is not periodic, and without a pair to look at."""
        periodic_all_over(case, "radial-distribution")
        half = min(case.box.size) / 2
        if self.reach is not None and self.reach > half:
            raise CaseError(
                f"reach = {self.reach:g}: expected at most {half:g}, half of the shortest side"
            )
        known = self.theory(case)
        first, second = known.first, known.second
        if len(self.kinds) == 2 and {g.first for g in first} & {g.first for g in second}:
            raise CaseError(f"kinds = {show(self.kinds)}: expected two different ones, or one")
        between = self.pairs == "between"
        if not second and (sum(g.number for g in first) if between else _size(first)) < 2:
            what = "molecules" if between else "particles or beads"
            raise CaseError(f"no pair to look at; expected two {what} at least")


@accumulator_of(RadialDistribution)
class RadialDistributionAccumulator(BlockAccumulator):
    """Block averages of g in bins, and of independent molecules the pairs that each makes.

    Blocks of a run in which molecules stay near see little of what their pairs scatter.
    """

    memory: ClassVar[tuple[str, ...]] = ("blocks", "own")

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.theory: Neighbours = observable.theory(case)
        self.first, self.second = self.theory.first, self.theory.second
        self.beads, self.others = (  # of each group (molecules, length), all or enough of them
            [
                group.beads(min(group.number, max(2, observable.particles // group.length)))
                if self.theory.sampled(group)
                else group.beads()
                for group in groups
            ]
            for groups in (self.first, self.second)
        )
        self.box = np.array(case.box.size, float)
        reach = observable.reach or min(FARTHEST * self.theory.size, min(case.box.size) / 2)
        self.edges = np.linspace(0.0, reach, observable.bins + 1)
        self.shells = shells(self.edges, case.box.dimension)
        self.near = np.zeros(0)  # edges of shells beyond contact
        if not math.isnan(self.theory.diameter):
            self.near = self.theory.diameter * np.linspace(1.0, BEYOND, SHELLS + 1)
        self.blocks = Blocks((observable.bins + max(0, len(self.near) - 1),))
        # all molecules of one kind are looked at, and are independent of one another
        whole = len(self.first) == 1 and len(self.beads[0]) == self.first[0].number > 1
        alone = whole and not self.second and self.theory.independent(self.first)
        self.own = OwnPairs(len(self.beads[0]), observable.bins) if alone else None

    def observe(self, fluid: RunningFluid) -> None:
        found = self.counts(fluid, self.edges) / self.shells
        if len(self.near):
            beyond = self.counts(fluid, self.near) / shells(self.near, self.case.box.dimension)
            found = np.concatenate([found, beyond])
        self.blocks.add(found * self.box.prod() / self.number())
        if self.own is not None:
            places = self.places(fluid, self.first, self.beads)[0]
            molecules = places.reshape(*self.beads[0].shape, -1)
            self.own.add_places(molecules, self.box, self.edges)

    def number(self) -> float:
        """Pairs that there are at any distance, of all molecules and not only the sample."""
        within, between = _pairs([(group.number, group.length) for group in self.first])
        if self.second:
            return float(_size(self.first) * _size(self.second))
        return between if self.observable.pairs == "between" else within + between

    def counts(self, fluid: RunningFluid, edges: Array) -> Array:
        """Pairs (bins,) of all between distances, as far as the sample reaches."""
        places = self.places(fluid, self.first, self.beads)
        one = np.concatenate(places)
        if self.second:
            other = np.concatenate(self.places(fluid, self.second, self.others))
            share = len(one) * len(other) / self.number()
            return count_pairs(one, other, self.box, edges) / share
        seen = count_pairs(one, None, self.box, edges)
        whole = [(group.number, group.length) for group in self.first]
        looked = [b.shape for b in self.beads]
        if looked == whole and self.observable.pairs == "all":
            return seen.astype(float)
        inside = np.zeros(len(seen), np.int64)
        for beads, r in zip(self.beads, places, strict=True):
            inside += count_within(r.reshape(*beads.shape, -1), self.box, edges)
        # molecules are taken as wholes: of pairs within them another part than of all others
        (within, between), (within_seen, between_seen) = _pairs(whole), _pairs(looked)
        found = (seen - inside) * (between / between_seen if between_seen else 0.0)
        if self.observable.pairs == "all" and within_seen:
            found = found + inside * (within / within_seen)
        return np.asarray(found, float)

    def places(self, fluid: RunningFluid, groups: list[Group], beads: list[Ids]) -> list[Array]:
        """Positions of the sample in each group: of other molecules at each sample."""
        found = []
        for group, ids in zip(groups, beads, strict=True):
            if len(ids) < group.number:
                turn = self.blocks.count * group.length
                ids = group.first + (ids - group.first + turn) % (group.number * group.length)
            found.append(fluid.positions(ids.ravel()))
        return found

    def result(self) -> Result:
        """g(r), beside 1 where particles are independent."""
        expected, found = self.expected(), self.means()
        error = _unless_fixed(found.value, self.errors(found, np.eye(len(self.shells))))
        return self.report(
            {"r": (self.edges[1:] + self.edges[:-1]) / 2},
            (found.value, error),
            self.comparisons(expected),
            expected=None if expected is None else np.full(len(self.shells), expected),
            theory="ideal gas",
            extra={"edges": self.edges},
        )

    def means(self) -> Estimate:
        """g in the bins."""
        return of_mean(self.blocks).part(slice(len(self.shells)))

    def errors(self, found: Estimate, combine: Array) -> Array:
        """Standard errors (n,) of linear combinations (n, bins) of g: in a short run those of the
        scatter of pairs, where they are larger."""
        if not self.blocks.count:
            return np.full(len(combine), np.nan)
        error = found.linear(combine).error
        if self.own is None or not self.short_run():
            return error
        scale = self.box.prod() / (self.number() * self.shells)
        least = self.own.error_of_pairs(combine * scale, self.observable.pairs == "all")
        return np.where(np.isnan(error), error, np.fmax(error, least))

    def expected(self) -> float | None:
        """1 of what is independent of all others; None within molecules, and with potentials."""
        groups = self.first + self.second
        bonded = max(group.length for group in groups) > 1
        if bonded and self.observable.pairs == "all" and not self.second:
            return None
        return 1.0 if self.theory.independent(groups) else None

    def comparisons(self, expected: float | None) -> Iterator[Comparison]:
        """Neighbours within the reach; without a theory also where g is largest."""
        if not self.blocks.count:
            return
        found, about = self.means(), self.number() / _size(self.first)
        density = about * (1 if self.second else 2) / float(self.box.prod())
        weights = density * self.shells
        value, error = float(weights @ found.value), self.errors(found, weights[None])[0]
        known = np.nan if expected is None else expected * float(weights.sum())
        short, error = self.short_run(), _unless_fixed(value, error)
        note = joined(f"r < {self.edges[-1]:g}", short)
        yield Comparison("neighbours within the reach", value, error, known, "", note)
        if expected is None:
            top = int(np.argmax(found.value))
            note = joined(f"at r = {(self.edges[top] + self.edges[top + 1]) / 2:.3g}", short)
            each = self.errors(found, np.eye(len(self.shells)))
            error = _unless_fixed(found.value[top], each[top])
            yield Comparison("largest g(r)", found.value[top], error, note=note)
        if len(self.near):  # a parabola through the shells beyond contact
            found, centres = of_mean(self.blocks), (self.near[1:] + self.near[:-1]) / 2
            powers = np.vander(centres / self.theory.diameter - 1.0, 3, increasing=True)
            weights = np.zeros(len(found.value))
            weights[len(self.shells) :] = np.linalg.pinv(powers)[0]
            at_contact = found.total(weights)
            yield Comparison("g at contact", *at_contact, self.theory.value, "", self.theory.note)

    def times(self) -> float:
        """Number of times in a run that two of them diffuse over the reach and forget their
        distance: R^2/(2 d D), D the sum of their coefficients; nan where these are not known."""
        first, second = (
            [self.theory.diffusion(group) for group in groups]
            for groups in (self.first, self.second)
        )
        if None in first + second:
            return np.nan
        slowest = min(filter(None, first))
        other = min(filter(None, second), default=slowest)
        blocks, case = self.blocks, self.case
        run = blocks.count / blocks.series * self.observable.every * method_of(case).timestep(case)
        return run * 2 * case.box.dimension * (slowest + other) / float(self.edges[-1]) ** 2

    def short_run(self) -> str:
        """Where blocking cannot see how slowly neighbours change: a note."""
        times = self.times()
        if not 0 < times < ENOUGH:
            return ""
        return of_relaxations(times, self.blocks.series, "diffusion times of the reach")


def _unless_fixed(value: Any, error: Any) -> Any:
    """The error, nan where it is that of rounding: a number that never changed."""
    return np.where(np.asarray(error) > ROUNDING * np.abs(value), error, np.nan)


def _size(groups: list[Group]) -> int:
    """Beads of them all."""
    return sum(group.number * group.length for group in groups)


def _pairs(groups: Sequence[tuple[int, ...]]) -> tuple[float, float]:
    """Pairs within molecules, and of different ones, of groups by their number and length."""
    within = sum(number * (length * (length - 1) // 2) for number, length in groups)
    size = sum(number * length for number, length in groups)
    return float(within), float(size * (size - 1) // 2 - within)
