"""Clusters of spheres: how many hang together."""

from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.loops.neighbours import near_pairs
from mesokit.seam.engine import RunningSpheres
from mesokit.seam.method import method_of
from mesokit.seam.observable import BlockAccumulator, Observable, accumulator_of
from mesokit.seam.result import Array, Comparison, Result
from mesokit.statistics import Blocks

USUAL_GAP = 0.1  # of the largest diameter


@component
class ClusterSize(Observable):
    """Shares of the spheres in clusters of 1, of 2 or 3, of 4 to 7 and so on.

    Two spheres whose surfaces are nearer than `gap` belong to one cluster, as do neighbours of
    neighbours. "mean" is the size of the cluster of a sphere taken at random.
    """

    quantity: Literal["contact-clusters"] = tag("contact-clusters")
    methods: ClassVar[tuple[str, ...]] = ("event-driven", "soft-spheres")
    of_methods_alone: ClassVar[bool] = True
    needs_fluid: ClassVar[bool] = False
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

    def __init__(self, observable: ClusterSize, case: Case) -> None:
        self.name, self.case = observable.label, case
        usual = USUAL_GAP * case.spheres.largest(case.box)
        self.gap = usual if observable.gap is None else observable.gap
        self.classes = case.particles.bit_length()
        self.blocks = Blocks((self.classes + 2,))
        closed = method_of(case).enclosure.closed_axes(case)
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
        listed = [
            Comparison(name, float(value[k]), float(error[k]), note=f"gap < {self.gap:g}")
            for name, k in zip(names, (-2, -1, 0), strict=True)
        ]
        return Result(
            quantity="contact-clusters",
            drawing="curve",
            name=self.name,
            x={"cluster of": np.array([str(2**k) for k in range(self.classes)])},
            value=value[:-2],
            error=error[:-2],
            label="share of the spheres, to below the next",
            units={"value": "", "cluster of": ""},
            comparisons=tuple(listed) if self.blocks.count else (),
            samples=self.blocks.count,
        )


def cluster_sizes(
    places: Array,
    diameters: Array,
    period: Array,
    gap: float,
) -> NDArray[np.int64]:
    """How many spheres each cluster has; an axis whose period is 0 does not repeat.

    >>> rows = np.array([[0.5, 1.0], [9.6, 1.0], [5.0, 5.0]])
    >>> cluster_sizes(rows, np.ones(3), np.array([10.0, 0.0]), 0.2)
    array([2, 1])
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(places)
    one, other, distance = near_pairs(places, float(diameters.max()) + gap, period)
    near = distance < 0.5 * (diameters[one] + diameters[other]) + gap
    ends = (one[near], other[near])
    graph = coo_array((np.ones(len(ends[0]), bool), ends), shape=(n, n))
    _, label = connected_components(graph, directed=False)
    return np.bincount(label)
