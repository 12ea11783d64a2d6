"""The network of contacts: how many each grain has, rattlers, and directions (fabric)."""

import itertools
from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.method.spheres.common.observe.bearing import GroupAccumulator, OfContacts
from mesokit.seam.engine import TouchingSpheres
from mesokit.seam.estimate import Array, Estimate
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Comparison, Result

MOST = {2: 10, 3: 20}  # contacts of a grain in the last bin, and more
GRAINS, TOUCHING, RATTLERS, BEARERS, HALVES, COUNT, FABRIC = range(7)  # columns of sums


@component
class ContactNetwork(OfContacts):
    """How many contacts a grain has, with and without rattlers, and the fabric tensor.

    Rattlers are left out one after another: without friction grains with at most d contacts (less
    than d under gravity, where the weight is a force more), with friction those with at most one.
    The coordination is twice the number of contacts over that of the other grains, contacts with
    walls included: so each contact counts once where forces are counted against equations of
    balance. Beside it stands the isostatic number (Alexander 1998), which frictionless packings
    have when they just bear a load; with friction it is a lower bound. The fabric tensor is the
    mean of n n over the normals of contacts between grains (Oda 1982), eigenvalues 1/d if they have
    no direction. Error bars are those of groups of grains, or of blocks of time if these are
    larger.
    """

    quantity: Literal["contact-network"] = tag("contact-network")
    drawing, value_label = "histogram", "share of the grains"
    units: ClassVar[dict[str, str]] = {"contacts": ""}


@accumulator_of(ContactNetwork)
class ContactNetworkAccumulator(GroupAccumulator):
    """Sums over grains and over contacts, by group of grains."""

    def prepare(self) -> None:
        case = self.case
        self.dimension = d = case.box.dimension
        self.pairs = list(itertools.combinations_with_replacement(range(d), 2))
        self.rubs = case.spheres.pair_friction > 0
        self.fewest = 2 if self.rubs else d + 1 - bool(case.spheres.gravity)
        self.bins = MOST[d] + 1
        self.width = FABRIC + len(self.pairs) + self.bins
        super().prepare()

    def observe(self, spheres: TouchingSpheres) -> None:
        found, n = self.contacts_of(spheres), spheres.n
        between, numbers = ~found.at_walls, np.arange(n)
        number = contacts_of_each(found.pairs, n)
        kept = bearers(found.pairs, n, self.fewest)
        ends = kept[found.pairs[:, 0]] & (kept[found.pairs[:, 1]] | found.at_walls)
        inside = found.pairs[ends]
        # Each contact counts twice: once for each of two grains, or twice for the one at a wall.
        halves = contacts_of_each(inside, n) + np.bincount(inside[inside[:, 1] < 0, 0], minlength=n)
        rows = np.zeros((n, self.width))
        rows[:, GRAINS], rows[:, TOUCHING], rows[:, RATTLERS] = 1.0, number, ~kept
        rows[:, BEARERS], rows[:, HALVES] = kept, halves
        place = np.minimum(number, self.bins - 1)
        rows[numbers, FABRIC + len(self.pairs) + place] = 1.0
        normals = found.normals[between]
        of_contacts = np.zeros((len(normals), self.width))
        of_contacts[:, COUNT] = 1.0
        for k, (a, b) in enumerate(self.pairs):
            of_contacts[:, FABRIC + k] = normals[:, a] * normals[:, b]
        group = np.concatenate([numbers, found.pairs[between, 0]])
        self.add(group, np.concatenate([rows, of_contacts]))

    def result(self) -> Result:
        """The distribution of the number of contacts, and what the network is like."""
        edges = np.arange(self.bins + 1) - 0.5
        known = self.blocks.count > 0
        value = error = np.full(self.bins, np.nan)
        if known:
            shares = self.ratio(slice(FABRIC + len(self.pairs), None), GRAINS)
            value, error = shares.value, shares.error
        mean = self._one(TOUCHING, GRAINS).value[0] if known else np.nan
        return self.report(
            {"contacts": np.arange(self.bins)},
            (value, error),
            self.comparisons(),
            extra={"edges": edges, "of": "contacts of a grain", "mean": float(mean)},
        )

    def _one(self, above: int, below: int) -> Estimate:
        return self.ratio(slice(above, above + 1), below)

    def comparisons(self) -> Iterator[Comparison]:
        """Contacts, rattlers, coordination beside the isostatic number, and the fabric."""

        def ratio(what: str, above: int, below: int, *more: float | str) -> Comparison:
            found = self._one(above, below)
            known, note = (*more, "")[:2] if more else (np.nan, "")
            return Comparison(what, found.value[0], found.error[0], known, "", note)  # type: ignore[arg-type]

        yield ratio("contacts of a grain", TOUCHING, GRAINS)
        yield ratio("share of rattlers", RATTLERS, GRAINS)
        sums = self.blocks.mean().sum(axis=0)
        if sums[BEARERS] > 0:
            yield ratio("coordination without rattlers", HALVES, BEARERS, *self.isostatic(sums))
        if sums[COUNT] > 0:
            yield from self.fabric(self.ratio(slice(FABRIC, FABRIC + len(self.pairs)), COUNT))

    def isostatic(self, sums: Array) -> tuple[float, str]:
        """The isostatic number, and what it is for these grains."""
        alone = not self.case.walls and not self.case.spheres.gravity
        grains = max(2, round(float(sums[BEARERS]))) if alone else None
        known = theory.isostatic_coordination(self.dimension, self.rubs, grains)
        if self.rubs:
            note = "isostatic with infinite friction; a packing at rest has as many or more"
            return known, f"approximate: {note}"
        return known, "approximate: isostatic, of a packing that just bears its load"

    def fabric(self, mean: Estimate) -> Iterator[Comparison]:
        """Eigenvalues of the fabric tensor, their difference, and the direction of the largest.

        An error of the tensor, dF, changes the eigenvalue of the eigenvector v by v dF v.
        """
        tensor = np.zeros((self.dimension, self.dimension))
        for (a, b), entry in zip(self.pairs, mean.value, strict=True):
            tensor[a, b] = tensor[b, a] = entry
        values, vectors = np.linalg.eigh(tensor)
        gradients = [derivative(v, v) for v in vectors.T]
        for k in range(self.dimension - 1, -1, -1):
            what = f"fabric eigenvalue {self.dimension - k}"
            yield Comparison(what, *mean.scalar(values[k], gradients[k]))
        split = mean.scalar(values[-1] - values[0], gradients[-1] - gradients[0])
        yield Comparison("fabric anisotropy", *split, note="largest less smallest eigenvalue")
        # An error dF turns the first eigenvector v towards each other one w by w dF v over the
        # difference of their eigenvalues; without a difference there is no direction.
        first, others = vectors[:, -1], range(self.dimension - 1)
        apart, slope = values[-1] - values[-2], gradients[-1] - gradients[-2]
        turns = {
            k: derivative(vectors[:, k], first) / ((values[-1] - values[k]) or 1.0) for k in others
        }
        alike = "none: isotropic within the error"
        if self.dimension == 2:
            angle = float(np.degrees(np.arctan2(first[1], first[0]))) % 180.0
            turned = vectors[:, 0] @ [-first[1], first[0]]  # 1 counterclockwise, else -1
            known = mean.scalar(angle, np.degrees(turned * turns[0]), over=(apart, slope))
            note = "from x" if np.isfinite(known[0]) else alike
            yield Comparison("direction of most contacts", *known, unit="degrees", note=note)
            return
        for a, axis in enumerate("xyz"):
            change = sum((vectors[a, k] * turns[k] for k in others), np.zeros(len(self.pairs)))
            known = mean.scalar(abs(first[a]), change, over=(apart, slope))
            note = "of a unit vector" if np.isfinite(known[0]) else alike
            yield Comparison(f"direction of most contacts along {axis}", *known, note=note)


def derivative(one: Array, other: Array) -> Array:
    """Derivatives of one F other by the entries of a symmetric tensor F, those of a row from the
    diagonal on.

    >>> derivative(np.array([1.0, 2.0]), np.array([3.0, 5.0])).tolist()
    [3.0, 11.0, 10.0]
    """
    entries = itertools.combinations_with_replacement(range(len(one)), 2)
    parts = [one[a] * other[b] + (one[b] * other[a] if a != b else 0.0) for a, b in entries]
    return np.array(parts)


def contacts_of_each(pairs: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Number of contacts (n,) of each grain, with grains and walls."""
    return np.bincount(pairs[pairs >= 0], minlength=n)


def bearers(pairs: NDArray[np.int64], n: int, fewest: int) -> NDArray[np.bool_]:
    """Which grains (n,) remain if those with fewer contacts than `fewest` are left out, and again.

    >>> chain = np.array([[0, 1], [1, 2], [2, 3], [3, 0], [3, 4]])
    >>> bearers(chain, 6, 2)
    array([ True,  True,  True,  True, False, False])
    """
    kept = np.ones(n, bool)
    while True:
        inside = kept[pairs[:, 0]] & (kept[pairs[:, 1]] | (pairs[:, 1] < 0))
        left = kept & (contacts_of_each(pairs[inside], n) >= fewest)
        if np.array_equal(left, kept):
            return kept
        kept = left
