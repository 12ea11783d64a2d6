"""Clusters: birds that are in reach of one another, directly or through others."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, show, tag
from mesokit.errors import CaseError
from mesokit.geometry.shape_protocol import closed_axes
from mesokit.loops.neighbours import near_pairs
from mesokit.method.flock.observe.protocol import FlockObservable
from mesokit.seam.estimate import of_mean
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Comparison, Result
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.method.flock.engine.flocks import Flocks
    from mesokit.seam.engine import Array

MOST_PAIRS = 5e7  # in one sample: more take gigabytes


@component
class ClusterSizes(FlockObservable):
    """Share of the birds that are in clusters of 1, 2 to 3, 4 to 7, ... birds.

    Two birds nearer than `distance` are in one cluster, and so are those linked by others.
    """

    quantity: Literal["cluster-sizes"] = tag("cluster-sizes")
    distance: float | None = param(
        None, doc="birds that are as near are linked (flock.radius unless said)", unit="a", gt=0
    )

    def check(self, case: Case) -> None:
        """Raise CaseError for a distance beyond half of the box, and for too many pairs."""
        super().check(case)
        near = self.near(case)
        if near >= 0.5 * min(case.box.size):
            raise CaseError(
                f"distance = {show(near)}: expected less than half of the box, "
                f"{0.5 * min(case.box.size):.4g}"
            )
        d, volume = case.box.dimension, math.prod(case.box.size)
        ball = math.pi * near**2 if d == 2 else 4 / 3 * math.pi * near**3
        pairs = 0.5 * case.particles**2 * ball / volume
        if pairs > MOST_PAIRS:
            raise CaseError(
                f"distance = {show(near)}: some {pairs:.2g} pairs of birds in each sample; "
                f"expected less than {MOST_PAIRS:.0e}"
            )

    def near(self, case: Case) -> float:
        """The distance in this case."""
        return float(case.flock.radius) if self.distance is None else self.distance


@accumulator_of(ClusterSizes)
class ClusterSizesAccumulator(BlockAccumulator):
    """Block averages of the shares, the mean size and the largest."""

    def __init__(self, observable: ClusterSizes, case: Case) -> None:
        self.case, self.name, self.near = case, observable.label, observable.near(case)
        shut = closed_axes(case.walls)
        self.around = np.array(
            [0.0 if a in shut else n for a, n in zip(case.box.axes, case.box.size, strict=True)]
        )
        self.bins = case.particles.bit_length()
        self.blocks = Blocks(self.bins + 2)

    def observe(self, engine: Flocks) -> None:
        sizes = clusters(engine.positions(), self.near, self.around)
        number = self.case.particles
        of_size = np.floor(np.log2(sizes) + 1e-9).astype(int)
        share = np.bincount(of_size, sizes, minlength=self.bins) / number
        mean = float((sizes.astype(float) ** 2).sum()) / number
        self.blocks.add(np.concatenate([share, [mean, sizes.max() / number]]))

    def result(self) -> Result:
        """Shares of the birds."""
        mean, error = self.blocks.mean(), self.blocks.error()
        return Result(
            quantity="cluster-sizes",
            drawing="clusters",
            name=self.name,
            x={"size": 2.0 ** np.arange(self.bins)},
            value=mean[: self.bins],
            error=error[: self.bins],
            label="share of the birds in clusters of this size and up to twice as large",
            units={"value": "", "size": ""},
            comparisons=tuple(self.comparisons()) if self.blocks.count else (),
            samples=self.blocks.count,
        )

    def comparisons(self) -> list[Comparison]:
        """The mean size of the cluster of a bird, and the largest cluster."""
        means = of_mean(self.blocks)
        found = []
        for row, what in ((-2, "mean size of the cluster of a bird"), (-1, "share of the largest")):
            gradient = np.zeros(self.bins + 2)
            gradient[row] = 1.0
            found.append(
                Comparison(what, *means.scalar(float(means.value[row]), gradient), note="no theory")
            )
        return found


def clusters(places: Array, near: float, around: Array) -> NDArray[np.int64]:
    """How many places there are in each cluster of those linked, in a box that is periodic along
    axes with a length in `around`.

    >>> clusters(np.array([[0.1, 1], [0.9, 1], [3.5, 1], [2, 3]]), 1.0, np.array([4.0, 0])).tolist()
    [3, 1]
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    one, other, _ = near_pairs(places, near, around)
    n = len(places)
    links = coo_matrix((np.ones(len(one), bool), (one, other)), shape=(n, n))
    _, labels = connected_components(links, directed=False)
    return np.bincount(labels)
