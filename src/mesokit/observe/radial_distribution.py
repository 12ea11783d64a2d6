"""Radial distribution function g(r): how many others there are at a distance."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator

from mesokit.case.component import component, param, show, tag
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected.molecules import Group, free_diffusion, kind_of
from mesokit.observe.shared.over_pairs import OwnPairs
from mesokit.observe.shared.pair_counts import count_pairs, count_within, shells
from mesokit.observe.shared.whose import OF, default_of, groups_of, periodic_all_over, strangers
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import Estimate, of_mean
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, Observable, State, pack, unpack
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case

Ids = NDArray[np.int64]
FARTHEST = 5.0  # unless a reach is given
ENOUGH = 100.0  # times of diffusion over the reach, for error bars
ROUNDING = 1e-12
BEYOND, SHELLS = 1.1, 5  # contact diameters to which shells reach, and their number


class Neighbours(Protocol):
    """What a method knows of equal spheres: their diameter and g at contact, nan if not known, and
    a note on it."""

    diameter: float
    value: float
    note: str


@component
class RadialDistribution(Observable):
    """Pairs at a distance r over those of as many independent particles, in a periodic box.

    Of a fluid some particles are looked at, which changes the error bars and not the mean; of
    solutes all beads, and of other methods all spheres. Of equal hard spheres g at contact is told,
    by shells just beyond it.
    """

    quantity: Literal["radial-distribution"] = tag("radial-distribution")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    needs_fluid: ClassVar[bool] = False
    of: Literal["beads", "particles"] | None = param(None, doc=OF)
    kinds: Many[int | str] = param(
        (),
        doc="one kind, or two: those of the second about one of the first (all unless said); names "
        "or numbers from 1, of solutes.polymers, fluid.species or spheres.kinds; 'fluid': its "
        "molecules",
        max_length=2,
    )
    pairs: Literal["all", "between"] = param(
        "all", doc='"between": only those of different molecules'
    )
    reach: float | None = param(
        None,
        doc="longest distance (half of the shortest side unless said; of fluids 5 at most, of "
        "spheres 5 of the largest diameter)",
        unit="a",
        gt=0,
    )
    bins: int = param(50, doc="bins of the distance", ge=1, le=10_000)
    particles: int = param(400, doc="of the fluid, those looked at, others at each sample", ge=2)

    @field_validator("of", mode="before")
    @classmethod
    def _no_kind(cls, of: Any) -> Any:
        if isinstance(of, str) and of not in ("beads", "particles"):
            raise ValueError("expected 'beads' or 'particles'; kinds are chosen by `kinds`")
        return of

    def check(self, case: Case) -> None:
        """Raise CaseError in a box that is not periodic, and without a pair to look at."""
        periodic_all_over(case, "radial-distribution")
        half = min(case.box.size) / 2
        if self.reach is not None and self.reach > half:
            raise CaseError(
                f"reach = {self.reach:g}: expected at most {half:g}, half of the shortest side"
            )
        first, second = self.chosen(case)
        if len(self.kinds) == 2 and {g.first for g in first} & {g.first for g in second}:
            raise CaseError(f"kinds = {show(self.kinds)}: expected two different ones, or one")
        number = sum(group.number * group.length for group in first)
        molecules = sum(group.number for group in first)
        if not second and (number < 2 or (self.pairs == "between" and molecules < 2)):
            what = "molecules" if self.pairs == "between" else "particles or beads"
            raise CaseError(f"no pair to look at; expected two {what} at least")

    def chosen(self, case: Case) -> tuple[list[Group], list[Group]]:
        """Groups of the first kind and of the second, which is empty for pairs within the first."""
        of = default_of(case, self.of)
        if not self.kinds:
            return groups_of(case, of), []
        try:
            first, *others = (groups_of(case, of, kind) for kind in self.kinds)
        except CaseError as error:  # which speaks of one kind
            known = str(error).partition(": ")[2]
            raise CaseError(f"kinds = {show(self.kinds)}: {known}") from None
        return first, others[0] if others else []

    def accumulator(self, case: Case) -> RadialDistributionAccumulator:
        """An empty memory for it."""
        return RadialDistributionAccumulator(self, case)


class RadialDistributionAccumulator(BlockAccumulator):
    """Block averages of g in bins, and of molecules that know nothing of others their own pairs.

    Blocks of a run in which molecules stay near see little of what their pairs scatter.
    """

    def __init__(self, observable: RadialDistribution, case: Case) -> None:
        observable.check(case)
        self.name, self.case, self.observable = observable.label, case, observable
        self.first, self.second = observable.chosen(case)
        most = observable.particles
        self.beads, self.others = (
            [_sample(case, group, most) for group in groups] for groups in (self.first, self.second)
        )
        self.box = np.array(case.box.size, float)
        method = method_of(case)
        unit = case.spheres.largest(case.box) if case.particles_have("diameter") else 1.0
        reach = observable.reach or min(FARTHEST * unit, min(case.box.size) / 2)
        self.edges = np.linspace(0.0, reach, observable.bins + 1)
        self.shells = shells(self.edges, case.box.dimension)
        known = method.expected.get("radial-distribution")
        self.theory: Neighbours | None = None if known is None else known(case, observable)
        self.near = np.zeros(0) if self.theory is None else _beyond(self.theory.diameter)
        self.blocks = Blocks((observable.bins + max(0, len(self.near) - 1),))
        self.own = OwnPairs(len(self.beads[0]), observable.bins) if self.alone() else None

    def alone(self) -> bool:
        """Whether all molecules of one kind are looked at, and know nothing of one another."""
        of, groups = default_of(self.case, self.observable.of), self.first
        whole = len(groups) == 1 and len(self.beads[0]) == groups[0].number > 1
        return whole and not self.second and strangers(self.case, of, groups)

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        found = self.counts(fluid, self.edges) / self.shells
        if len(self.near):
            beyond = self.counts(fluid, self.near) / shells(self.near, self.case.box.dimension)
            found = np.concatenate([found, beyond])
        self.blocks.add(found * self.box.prod() / self.number())
        if self.own is not None:
            places = self.places(fluid, self.first, self.beads)[0]
            molecules = places.reshape(*self.beads[0].shape, -1)
            self.own.add(molecules, self.box, self.edges)

    def state(self) -> State:
        """All it has to remember."""
        own = {} if self.own is None else pack(own=self.own)
        return super().state() | own

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        super().restore(state)
        if self.own is not None:
            self.own.restore(unpack(state, "own"))

    def pool(self, other: BlockAccumulator) -> None:
        """Take in the samples of an independent run of the same case: only to read."""
        assert isinstance(other, RadialDistributionAccumulator)
        super().pool(other)
        if self.own is not None and other.own is not None:
            self.own.pool(other.own)

    def number(self) -> float:
        """Pairs that there are at any distance, of all molecules and not only the sample."""
        within, between = _pairs(self.first)
        if self.second:
            return float(_size(self.first) * _size(self.second))
        return between if self.observable.pairs == "between" else within + between

    def counts(self, fluid: RunningFluid, edges: Array) -> Array:
        """Pairs (bins,) of all between distances, as far as the sample knows."""
        places = self.places(fluid, self.first, self.beads)
        one = np.concatenate(places)
        if self.second:
            other = np.concatenate(self.places(fluid, self.second, self.others))
            share = len(one) * len(other) / self.number()
            return count_pairs(one, other, self.box, edges) / share
        seen = count_pairs(one, None, self.box, edges)
        looked = [g._replace(number=len(b)) for g, b in zip(self.first, self.beads, strict=True)]
        if looked == self.first and self.observable.pairs == "all":
            return seen.astype(float)
        inside = np.zeros(len(seen), np.int64)
        for beads, r in zip(self.beads, places, strict=True):
            inside += count_within(r.reshape(*beads.shape, -1), self.box, edges)
        # molecules are taken as wholes: of pairs within them another part than of all others
        (within, between), (within_seen, between_seen) = _pairs(self.first), _pairs(looked)
        found = (seen - inside) * (between / between_seen if between_seen else 0.0)
        if self.observable.pairs == "all" and within_seen:
            found = found + inside * (within / within_seen)
        return np.asarray(found, float)

    def places(self, fluid: RunningFluid, groups: list[Group], beads: list[Ids]) -> list[Array]:
        """Of the sample in each group: other molecules each time, so that few tell of all soon."""
        found = []
        for group, ids in zip(groups, beads, strict=True):
            if len(ids) < group.number:
                turn = self.blocks.count * group.length
                ids = group.first + (ids - group.first + turn) % (group.number * group.length)
            found.append(fluid.positions(ids.ravel()))
        return found

    def result(self) -> Result:
        """g(r), beside 1 where nobody knows of others."""
        expected, found = self.expected(), self.means()
        return Result(
            quantity="radial-distribution",
            name=self.name,
            x={"r": (self.edges[1:] + self.edges[:-1]) / 2},
            value=found.value,
            error=_unless_fixed(found.value, self.errors(found, np.eye(len(self.shells)))),
            label="g(r)",
            units={"value": "", "r": "a"},
            expected=None if expected is None else np.full(len(self.shells), expected),
            theory="ideal gas",
            comparisons=tuple(self.comparisons(expected)),
            samples=self.blocks.count,
            extra={"edges": self.edges},
        )

    def means(self) -> Estimate:
        """g in the bins."""
        found, bins = of_mean(self.blocks), len(self.shells)
        return found._replace(value=found.value[:bins], residuals=found.residuals[:, :bins])

    def errors(self, found: Estimate, combine: Array) -> Array:
        """Standard errors (n,) of linear combinations (n, bins) of g: in a short run those of the
        scatter of pairs, where they are larger."""
        if not self.blocks.count:
            return np.full(len(combine), np.nan)
        error = found.linear(combine).error
        if self.own is None or not self.short_run():
            return error
        scale = self.box.prod() / (self.number() * self.shells)
        least = self.own.error(combine * scale, self.observable.pairs == "all")
        return np.where(np.isnan(error), error, np.fmax(error, least))

    def expected(self) -> float | None:
        """1 of what is independent of all others; None within molecules, and with potentials."""
        case, groups = self.case, self.first + self.second
        bonded = max(group.length for group in groups) > 1
        if bonded and self.observable.pairs == "all" and not self.second:
            return None
        return 1.0 if strangers(case, default_of(case, self.observable.of), groups) else None

    def comparisons(self, expected: float | None) -> list[Comparison]:
        """Neighbours within the reach; without a theory also where g is largest."""
        if not self.blocks.count:
            return []
        found, about = self.means(), self.number() / _size(self.first)
        density = about * (1 if self.second else 2) / float(self.box.prod())
        weights = density * self.shells
        value, error = float(weights @ found.value), self.errors(found, weights[None])[0]
        error = float(_unless_fixed(value, error))
        known = np.nan if expected is None else expected * float(weights.sum())
        short = self.short_run()
        note = "; ".join(filter(None, (f"r < {self.edges[-1]:g}", short)))
        listed = [Comparison("neighbours within the reach", value, error, known, "", note)]
        if expected is None:
            top = int(np.argmax(found.value))
            note = f"at r = {(self.edges[top] + self.edges[top + 1]) / 2:.3g}"
            note = "; ".join(filter(None, (note, short)))
            height = float(found.value[top])
            each = self.errors(found, np.eye(len(self.shells)))
            error = float(_unless_fixed(height, each[top]))
            listed.append(Comparison("largest g(r)", height, error, note=note))
        if self.theory is not None and len(self.near):
            listed.append(self.contact(self.theory))
        return listed

    def contact(self, theory: Neighbours) -> Comparison:
        """g at contact: a parabola through the shells beyond it."""
        found, centres = of_mean(self.blocks), (self.near[1:] + self.near[:-1]) / 2
        powers = np.vander(centres / theory.diameter - 1.0, 3, increasing=True)
        weights = np.zeros(len(found.value))
        weights[len(self.shells) :] = np.linalg.pinv(powers)[0]
        value, error = found.scalar(weights @ found.value, weights)
        return Comparison("g at contact", value, error, theory.value, "", theory.note)

    def times(self) -> float:
        """How often in a run two of them diffuse over the reach, after which their distance is
        forgotten: R^2/(2 d D), D the sum of their coefficients; nan where these are not known."""
        case, of = self.case, default_of(self.case, self.observable.of)
        centres = [self.diffusion(group, of) for group in self.first + self.second]
        if any(found is None for found in centres):
            return np.nan
        slowest = min(found for found in centres[: len(self.first)] if found)
        other = min([found for found in centres[len(self.first) :] if found], default=slowest)
        run = (
            self.blocks.count
            / self.blocks.series
            * self.observable.every
            * method_of(case).timestep(case)
        )
        reach = float(self.edges[-1])
        return run * 2 * case.box.dimension * (slowest + other) / reach**2

    def diffusion(self, group: Group, of: str) -> float | None:
        """Coefficient of the molecules of a group, by molecular chaos: Rouse's."""
        if self.case.particles_have("diameter"):
            return None
        alone = free_diffusion(self.case, of, kind_of(self.case, group))
        return None if alone is None else alone / group.length

    def short_run(self) -> str:
        """Where blocking cannot see how slowly neighbours change: a note."""
        times = self.times()
        if not 0 < times < ENOUGH:
            return ""
        return f"error bar is a lower bound: the run has {times:.2g} diffusion times of the reach"


def _unless_fixed(value: Array | float, error: Array | float) -> Array:
    """The error, nan where it is that of rounding: a number that never changed."""
    return np.where(np.asarray(error) > ROUNDING * np.abs(value), error, np.nan)


def _sample(case: Case, group: Group, most: int) -> Ids:
    """Beads (molecules, length) of a group; of the fluid of so many as have `most` at least."""
    if group.first >= case.particles or case.particles_have("diameter"):
        return group.beads()
    return group.beads(min(group.number, max(2, most // group.length)))


def _beyond(diameter: float) -> Array:
    """Edges of shells from contact on; none without a diameter of all."""
    return np.zeros(0) if math.isnan(diameter) else diameter * np.linspace(1.0, BEYOND, SHELLS + 1)


def _size(groups: list[Group]) -> int:
    """Beads of them all."""
    return sum(group.number * group.length for group in groups)


def _pairs(groups: list[Group]) -> tuple[float, float]:
    """Pairs within molecules, and of different ones."""
    within = sum(group.number * (group.length * (group.length - 1) // 2) for group in groups)
    size = _size(groups)
    return float(within), float(size * (size - 1) // 2 - within)
