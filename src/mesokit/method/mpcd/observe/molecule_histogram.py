"""Distribution of a number of molecules: size, ends, orientation, place of the centre."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.compression import unit_cell
from mesokit.method.mpcd.expected.ideal import flow_axis, mean_shape, stretched, undisturbed
from mesokit.method.mpcd.expected.molecules import ends_at_rest, free_bond, modes_at_rest
from mesokit.method.mpcd.expected.selection import KIND, group_of, molecule_of
from mesokit.method.mpcd.expected.traps import held, squares_from_middle, trapped
from mesokit.observe.shared.over_molecules import MeansOverMolecules
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import BlockAccumulator, Observable, State, accumulator_of
from mesokit.seam.result import Array, Comparison, Result, joined

FINE = 480  # bins in memory; those of a result are of several
DIVISORS = tuple(n for n in range(1, FINE + 1) if FINE % n == 0)
WORDS = {
    "gyration": "radius of gyration",
    "end-to-end": "end-to-end distance",
    "orientation": "cosine of the end-to-end vector",
    "centre": "centre of mass",
}


@component
class MoleculeHistogram(Observable):
    """Probability density of one number of molecules, beside that of ideal ones at rest."""

    quantity: Literal["molecule-histogram"] = tag("molecule-histogram")
    needs_fluid: ClassVar[bool] = False
    drawing = "histogram"
    value_label = "probability density"
    of: Literal["gyration", "end-to-end", "orientation", "centre"] = param(
        "gyration",
        doc="radius of gyration; of chains the end-to-end distance (with `axis` its component), "
        '"orientation": cosine of their ends against the axis; "centre": of mass, along the axis',
    )
    axis: Axis | None = param(
        None,
        doc='axis of "orientation" and "centre" (that of the force on the fluid, x unless there '
        'is one), or of the component of "end-to-end" (the distance unless said)',
    )
    length: float | None = param(
        None,
        doc="of a unit cell, in which all centres are counted (that of an array, else the box, "
        "unless said)",
        unit="a",
        gt=0,
    )
    largest: float | None = param(
        None,
        doc="largest size that is counted (that of a stretched molecule unless said)",
        unit="a",
        gt=0,
    )
    bins: int = param(40, doc="bins over what is found, at most", ge=4, le=FINE)
    molecules: int = param(2000, doc="molecules looked at, evenly spread over all", ge=1)
    kind: int | str = param(1, doc=KIND)

    def check(self, case: Case) -> None:
        """Raise CaseError without molecules, and for what they have not."""
        molecule = molecule_of(case, self.quantity, self.kind)
        if self.axis is not None:
            case.box.index(self.axis)
        if self.of in ("end-to-end", "orientation") and molecule.topology != "chain":
            raise CaseError(f"of = {self.of!r}: only chains have two ends")
        if self.of == "gyration" and self.axis is not None:
            raise CaseError("axis: no effect with of = 'gyration'; leave it out")
        if self.length is not None and self.of != "centre":
            raise CaseError(f"length: no effect with of = {self.of!r}; only with of = 'centre'")
        if self.largest is not None and self.of not in ("gyration", "end-to-end"):
            raise CaseError(f"largest: no effect with of = {self.of!r}; leave it out")
        if self.of == "centre" and flow_axis(case, self.axis) == 0 and case.box.sheared:
            raise CaseError("of = 'centre': not along 'x' under shear, whose images slide")


@accumulator_of(MoleculeHistogram)
class MoleculeHistogramAccumulator(BlockAccumulator):
    """Shares of the molecules in fine bins."""

    def prepare(self) -> None:
        observable, case = self.observable, self.case
        self.group = group_of(case, "beads", observable.kind)
        self.beads = self.group.beads(observable.molecules)
        self.axis, self.dimension = flow_axis(case, observable.axis), case.box.dimension
        self.mean = mean_shape(case, observable.kind, self.group)
        self.edges = np.linspace(*self.limits(), FINE + 1)
        self.means = MeansOverMolecules(len(self.beads), FINE)

    def limits(self) -> tuple[float, float]:
        """Between which numbers the bins lie."""
        observable, molecule = self.observable, self.group.molecule
        assert molecule is not None
        if observable.of == "orientation":
            return -1.0, 1.0
        if observable.of == "centre":
            return 0.0, observable.length or unit_cell(self.case, self.axis)
        most = observable.largest
        if most is None:
            most = stretched(self.case, molecule)
            if self.mean is not None:  # and what pulls add
                most += float(np.linalg.norm(np.ptp(self.mean, axis=0)))
            most *= 0.5 if observable.of == "gyration" else 1.0
        return (-most if self.component else 0.0), most

    @property
    def component(self) -> bool:
        """Whether it is a component of the end-to-end vector."""
        return self.observable.of == "end-to-end" and self.observable.axis is not None

    def observe(self, fluid: RunningFluid) -> None:
        found = self.numbers(fluid)
        width = self.edges[1] - self.edges[0]
        place = np.floor((found - self.edges[0]) / width).astype(int)
        each = np.zeros((len(found), FINE))
        inside = (place >= 0) & (place < FINE)
        each[np.flatnonzero(inside), place[inside]] = 1.0
        self.means.add(each)

    def numbers(self, fluid: RunningFluid) -> Array:
        """The number of each molecule that is counted, (molecules,)."""
        of, ids = self.observable.of, self.beads.ravel()
        shape = (*self.beads.shape, self.dimension)
        if of == "centre":
            r = fluid.positions(ids, unwrapped=True).reshape(shape)
            return np.asarray(r[:, :, self.axis].mean(axis=1) % self.edges[-1])
        r = fluid.whole_positions(ids).reshape(shape)
        if of == "gyration":
            return np.sqrt(((r - r.mean(axis=1, keepdims=True)) ** 2).sum(axis=(1, 2)) / shape[1])
        ends = r[:, -1] - r[:, 0]
        if self.component:
            return ends[:, self.axis]
        length = np.sqrt((ends**2).sum(axis=1))
        if of == "end-to-end":
            return length
        cosine = ends[:, self.axis] / np.where(length > 0, length, 1.0)
        return np.minimum(cosine, np.nextafter(1.0, 0.0))  # 1 is in the last bin

    def state(self) -> State:
        return self.means.state()

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        self.means.restore(state)

    def pool(self, other: MoleculeHistogramAccumulator) -> None:
        self.means.pool(other.means)

    def result(self) -> Result:
        first, last, many = self.coarse()
        edges = self.edges[first : last + 1 : many]
        combine = np.zeros((len(edges) - 1, FINE))
        for k in range(len(combine)):
            combine[k, first + k * many : first + (k + 1) * many] = 1 / (edges[1] - edges[0])
        known = self.cdf(self.edges)
        expected = None if known is None else np.diff(known[first : last + 1 : many])
        name = {"centre": AXES[self.axis], "end-to-end": "R", "gyration": "Rg"}.get(
            self.observable.of, "cosine"
        )
        name = f"R{AXES[self.axis]}" if self.component else name
        unit = "" if name == "cosine" else "a"
        law = "ideal molecules"
        if self.observable.of == "centre":
            in_traps = trapped(self.case, self.observable.kind)
            law = "Boltzmann in traps" if in_traps else "anywhere alike"
        return self.report(
            {name: (edges[1:] + edges[:-1]) / 2},
            (self.means.mean(combine), self.means.error(combine)),
            self.comparisons(known),
            units={"value": "1/a" if unit else "", name: unit},
            expected=None if expected is None else expected / (edges[1] - edges[0]),
            theory=law,
            samples=self.means.blocks.count,
            extra={"edges": edges, "of": self.words()},
        )

    def spread(self, share: Array) -> Comparison:
        """Mean square distance from the expected middle, by the shorter way round the box."""
        length, middle = self.edges[-1], (self.edges[1:] + self.edges[:-1]) / 2
        square = squares_from_middle(middle, share, length)
        what = f"mean square distance from the middle of the traps along {AXES[self.axis]}"
        expected, note = float(square @ share), self.means.caution()
        return Comparison(what, *self.means.total(square), expected, "a^2", note)

    def words(self) -> str:
        words, axis = WORDS[self.observable.of], AXES[self.axis]
        if self.component:
            return f"end-to-end vector along {axis}"
        against = {"orientation": f" against {axis}", "centre": f" along {axis}"}
        return words + against.get(self.observable.of, "")

    def coarse(self) -> tuple[int, int, int]:
        """First and last fine edge of the result, and fine bins in each of its bins."""
        found = np.flatnonzero(self.means.mean() > 0)
        if self.observable.of in ("centre", "orientation") or not len(found):
            found = np.array([0, FINE - 1])
        for many in DIVISORS:
            first, last = found[0] // many * many, (found[-1] // many + 1) * many
            if (last - first) // many <= self.observable.bins:
                break
        return int(first), int(last), many

    def cdf(self, edges: Array) -> Array | None:
        """Expected share below each edge; None without a theory."""
        of, case, kind = self.observable.of, self.case, self.observable.kind
        molecule, d = self.group.molecule, self.dimension
        assert molecule is not None
        if of == "centre" and trapped(case, kind):
            return self.cdf_in_traps(edges)
        if of == "centre":
            uneven = case.walls or setting.gathered(case)
            return None if uneven else (edges - edges[0]) / (edges[-1] - edges[0])
        if of == "orientation":
            quiet = undisturbed(case) or self.as_at_rest()
            return theory.cosine_cdf(edges, d) if quiet else None
        bond = free_bond(case, kind)
        if bond is None or self.mean is None:
            return None
        if self.component:
            from scipy.special import ndtr

            ends = ends_at_rest(case, kind, bond)
            middle = (self.mean[-1] - self.mean[0])[self.axis]
            return np.asarray(ndtr((edges - middle) / (ends / d) ** 0.5))
        if not self.as_at_rest():
            return None
        if of == "gyration":
            return theory.gyration_cdf(edges, modes_at_rest(case, kind), bond, d)
        return theory.end_to_end_cdf(edges, ends_at_rest(case, kind, bond), d)

    def as_at_rest(self) -> bool:
        """Whether ideal molecules have the shape that they have at rest."""
        return self.mean is not None and not self.mean.any()

    def cdf_in_traps(self, edges: Array) -> Array | None:
        """Of the centres of molecules that traps hold, counted in a unit cell."""
        found, length = held(self.case, self.observable.kind), float(edges[-1])
        if found is None:
            return None
        share = theory.normal_in_box(
            edges, float(found.centre[self.axis]), found.centre_variance, length
        )
        return np.concatenate([[0.0], np.cumsum(share)])

    def comparisons(self, known: Array | None) -> Iterator[Comparison]:
        """The mean, by the middles of the fine bins, as theory is taken too; of centres in traps
        the mean square distance from where they are in the mean."""
        if self.observable.of == "centre":
            if known is None or not trapped(self.case, self.observable.kind):
                return
            yield self.spread(np.diff(known))
            return
        middle = (self.edges[1:] + self.edges[:-1]) / 2
        expected = np.nan if known is None else float(middle @ np.diff(known))
        outside = 1 - float(self.means.mean().sum())
        left = f"{100 * outside:.2g} % larger than largest are left out" if outside > 1e-9 else ""
        note = joined(left, self.means.caution())
        unit = "" if self.observable.of == "orientation" else "a"
        what, found = f"mean {self.words()}", self.means.total(middle)
        yield Comparison(what, *found, expected, unit, note)
