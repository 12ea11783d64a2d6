"""Sums over pairs of sites by their separation, by fast Fourier transforms.

A site at whole coordinates c is at c * spacing, and at `shift` from there if its parity is odd. So
the separation of two sites depends on the difference of their coordinates and on the parity of the
first: one transform for each parity has them all.
"""

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import Array

NONE = -1  # the shell of pairs that are in none


class Separations:
    """Pairs of sites in shells, by their distance.

    direction: "radius" has the nearest neighbours, and shells of width 1 around whole distances
    from 2 on; an axis has the pairs along it. distance: (shells,) mean distance of the pairs, in
    distances of neighbours. Shells end at half of the shortest length of the lattice, where
    periodic images begin.
    """

    def __init__(self, case: Case, direction: str) -> None:
        kind = case.lattice.lattice
        size = tuple(map(int, case.box.size))
        closed = [axis in case.lattice.ends for axis in case.box.axes]
        # beyond an end there are zeros, so that no pair joins two ends
        self.size = size
        self.padded = tuple(2 * n if end else n for n, end in zip(size, closed, strict=True))
        odd = odd_sites(size, kind.parity)
        self.first = [~odd, odd] if odd.any() else [np.ones(size, bool)]
        offsets = np.meshgrid(*(np.rint(np.fft.fftfreq(n) * n) for n in self.padded), indexing="ij")
        changes = sum(x * p for x, p in zip(offsets, kind.parity, strict=True)) % 2
        half = 0.5 * min(n * a for n, a in zip(size, kind.spacing, strict=True))
        apart = [
            np.sqrt(
                sum(
                    (x * a + sign * changes * s) ** 2
                    for x, a, s in zip(offsets, kind.spacing, kind.shift, strict=True)
                )
            )
            for sign in (1, -1)[: len(self.first)]
        ]
        if direction == "radius":
            # what is further away than neighbours are is not with these
            shells = [np.where(r > 1 + 1e-6, np.maximum(np.rint(r), 2), np.rint(r)) for r in apart]
            self.shells = [
                np.where(r <= half, shell, NONE).astype(int)
                for r, shell in zip(apart, shells, strict=True)
            ]
        else:
            along = case.box.index(direction, "direction")
            period = 1 + kind.parity[along]  # rows until one is in line with the first
            half = 0.5 * size[along]
            here = abs(offsets[along])
            there = (here % period == 0) & (here <= half)
            for k, x in enumerate(offsets):
                there &= (x == 0) | (k == along)
            self.shells = [np.where(there, here // period, NONE).astype(int) for _ in apart]
        self.number = 1 + max(int(shell.max()) for shell in self.shells)
        everywhere = np.ones(size)
        self.pairs = self._by_shell([np.rint(c) for c in self._products(everywhere)])
        whole = self._by_shell(
            [np.rint(c) * r for c, r in zip(self._products(everywhere), apart, strict=True)]
        )
        seen = self.pairs > 0
        self.distance = np.where(
            seen, whole / np.where(seen, self.pairs, 1), np.arange(self.number)
        )

    def mean_products(self, field: Array) -> Array:
        """Mean product (shells,) of a field (size) at both sites of the pairs in each shell."""
        return self._by_shell(self._products(field)) / np.maximum(self.pairs, 1)

    def _products(self, field: Array) -> list[Array]:
        """Sums over first sites of the products, by the offset of the second, for each parity."""
        axes = tuple(range(field.ndim))
        every = np.fft.rfftn(field, self.padded, axes)
        found: list[Array] = []
        for first in self.first:
            one = every if first.all() else np.fft.rfftn(field * first, self.padded, axes)
            found.append(np.fft.irfftn(one.conj() * every, self.padded, axes))
        return found

    def _by_shell(self, products: list[Array]) -> Array:
        total = np.zeros(self.number)
        for shell, some in zip(self.shells, products, strict=True):
            use = shell > NONE
            total += np.bincount(shell[use], some[use], minlength=self.number)
        return total


def odd_sites(size: tuple[int, ...], parity: tuple[int, ...]) -> NDArray[np.bool_]:
    """Whether the sites (size) are odd, by the axes whose coordinates make the parity."""
    whole = np.indices(size, sparse=True)
    odd = sum(x * p for x, p in zip(whole, parity, strict=True)) % 2
    return np.broadcast_to(odd == 1, size)
