"""Images of things over the edges of a periodic box."""

import itertools
from collections.abc import Collection, Sequence

import numpy as np

from mesokit.case.case import Case
from mesokit.report.flow.data import Array
from mesokit.seam.method import method_of


def shifts(case: Case, time: float, axes: Collection[int]) -> Array:
    """Vectors (n, d) to a place itself, first, and to its images one box away along some axes.

    Images above and below have slid under shear.
    """
    closed = method_of(case).enclosure.closed_axes(case)
    edges = np.diag(np.array(case.box.size, float))
    if case.box.sheared:
        edges[1, 0] = case.box.displacement(time) % edges[0, 0]
    once = [
        (0, 1, -1) if k in axes and k not in closed else (0,) for k in range(case.box.dimension)
    ]
    counts = np.array(list(itertools.product(*once)))
    if case.box.sheared:  # by up to a box: of these one more lies over the other edge
        beyond = counts.copy()
        beyond[:, 0] -= counts[:, 1]
        counts = np.unique(np.concatenate([counts, beyond]), axis=0)
        counts = counts[np.argsort((counts**2).sum(axis=1), kind="stable")]
    found: Array = counts @ edges
    return found


def towards(columns: Sequence[int]) -> float:
    """Sign of the third axis of the box towards the eye, in a right-handed picture of two axes."""
    return 1.0 if (columns[1] - columns[0]) % 3 == 1 else -1.0
