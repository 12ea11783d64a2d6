"""Neighbours of all sites at once, as arrays of the shape of the lattice."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.observe.shared.separations import odd_sites


class Neighbours:
    """The neighbours of each site of a lattice.

    size: sites along each axis.
    """

    def __init__(self, case: Case) -> None:
        self.kind = case.lattice.lattice
        self.size = tuple(map(int, case.box.size))
        self._odd = odd_sites(self.size, self.kind.parity)
        closed = [axis in case.lattice.ends for axis in case.box.axes]
        self._whole = np.indices(self.size, sparse=True)
        self._closed = [k for k, end in enumerate(closed) if end]

    def pairs(self, values: NDArray[Any]) -> Iterator[tuple[NDArray[Any], NDArray[np.bool_]]]:
        """For each direction the values (size) at the neighbours, and whether the pair counts.

        A pair counts at one of its two sites: at that from which the neighbour is ahead along the
        first axis along which they differ.
        """
        axes = tuple(range(values.ndim))
        for direction in range(self.kind.neighbours):
            even, odd = self.kind.shifts[:, direction].tolist()
            there = np.roll(values, [-x for x in even], axes)
            counts = np.broadcast_to(self._counts(even), self.size)
            if even != odd:
                there = np.where(self._odd, np.roll(values, [-x for x in odd], axes), there)
                counts = np.where(self._odd, self._counts(odd), counts)
            if counts.any():
                yield there, counts

    def _counts(self, step: list[int]) -> NDArray[np.bool_]:
        """Whether a step is ahead, and ends within the lattice."""
        counts = np.array(tuple(step) > (0,) * len(step))
        for k in self._closed:
            x = self._whole[k] + step[k]
            counts = counts & (x >= 0) & (x < self.size[k])
        return counts
