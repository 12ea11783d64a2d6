"""Clusters of spheres: how many hang together."""

from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, param, tag
from mesokit.geometry.walls import closed_axes
from mesokit.method.spheres.common.observe.protocol import OfSpheres
from mesokit.method.spheres.common.observe.shared.bed_surface import clusters
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.observable import BlockAccumulator, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

USUAL_GAP = 0.1  # of the largest diameter


@component
class ClusterSize(OfSpheres):
    """Shares of the spheres in clusters of 1, of 2 or 3, of 4 to 7 and so on.

    Two spheres whose surfaces are nearer than `gap` belong to one cluster, as do neighbours of
    neighbours. "mean" is the size of the cluster of a sphere taken at random.
    """

    quantity: Literal["contact-clusters"] = tag("contact-clusters")
    value_label = "share of the spheres, to below the next"
    units: ClassVar[dict[str, str]] = {"cluster of": ""}
    gap: float | None = param(
        None,
        doc="between the surfaces of neighbours, at most (a tenth of the largest diameter unless "
        "said)",
        unit="a",
        gt=0,
    )


@accumulator_of(ClusterSize)
class ClusterSizeAccumulator(BlockAccumulator):
    """Block averages of the shares, of the mean and of the largest."""

    def prepare(self) -> None:
        case, gap = self.case, self.observable.gap
        self.gap = USUAL_GAP * case.spheres.largest(case.box) if gap is None else gap
        self.classes = case.particles.bit_length()
        self.blocks = Blocks((self.classes + 2,))
        closed = closed_axes(case)
        self.repeats = np.array([k not in closed for k in range(case.box.dimension)])

    def observe(self, spheres: RunningSpheres) -> None:
        period = np.where(self.repeats, spheres.box, 0.0)  # 0: this axis does not repeat
        sizes = cluster_sizes(spheres.positions(), spheres.diameters(), period, self.gap)
        place = np.frexp(sizes.astype(float))[1] - 1
        shares = np.bincount(place, sizes, self.classes) / spheres.n
        mean = float(sizes @ sizes) / spheres.n
        self.blocks.add([*shares, mean, sizes.max() / spheres.n])

    def result(self) -> Result:
        """The shares, beside no theory."""
        value, error = self.blocks.mean(), self.blocks.error()
        names = ("mean cluster of a sphere", "share of the largest cluster", "single spheres")
        return self.report(
            {"cluster of": [str(2**k) for k in range(self.classes)]},
            (value[:-2], error[:-2]),
            (
                Comparison(name, value[k], error[k], note=f"gap < {self.gap:g}")
                for name, k in zip(names, (-2, -1, 0), strict=True)
            ),
        )


def cluster_sizes(places: Array, diameters: Array, period: Array, gap: float) -> NDArray[np.int64]:
    """Number of spheres in each cluster; an axis whose period is 0 does not repeat.

    >>> rows = np.array([[0.5, 1.0], [9.6, 1.0], [5.0, 5.0]])
    >>> cluster_sizes(rows, np.ones(3), np.array([10.0, 0.0]), 0.2)
    array([2, 1])
    """
    return np.bincount(clusters(places, diameters, period, gap))
