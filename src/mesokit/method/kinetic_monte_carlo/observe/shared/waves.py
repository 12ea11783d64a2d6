"""Fourier transforms of fields on a lattice, at the places where its sites truly are."""

import math

import numpy as np

from mesokit.case.case import Case
from mesokit.method.kinetic_monte_carlo.observe.shared.fields import Array
from mesokit.method.kinetic_monte_carlo.observe.shared.separations import odd_sites


class Waves:
    """Wave vectors that fit into the lattice, and rings of them.

    lengths: (size) of the wave vectors, in inverse distances of neighbours. ring: (size) the number
    of the ring of each, 0 for none. A ring is as wide as the shortest wave vector of the longest
    axis; rings end at the largest circle that holds all its wave vectors, or at `largest`.
    numbers, mean: wave vectors in each ring, and their mean length.
    """

    def __init__(self, case: Case, largest: float = math.inf) -> None:
        kind = case.lattice.lattice
        self.size = tuple(map(int, case.box.size))
        axes = [
            2 * math.pi * np.fft.fftfreq(n) / a
            for n, a in zip(self.size, kind.spacing, strict=True)
        ]
        vectors = np.meshgrid(*axes, indexing="ij", sparse=True)
        odd = odd_sites(self.size, kind.parity)
        self.odd = odd if odd.any() else None
        # odd sites are further on than their coordinates say
        self.turn = np.exp(-1j * sum(k * s for k, s in zip(vectors, kind.shift, strict=True)))
        self.lengths = np.sqrt(sum(k**2 for k in vectors))
        width = min(2 * math.pi / (n * a) for n, a in zip(self.size, kind.spacing, strict=True))
        most = min(largest, *(math.pi / a for a in kind.spacing)) * (1 + 1e-9)
        ring = np.rint(self.lengths / width).astype(int)
        self.ring = np.where(self.lengths <= most, ring, 0)
        self.numbers = np.bincount(self.ring.ravel())[1:]
        whole = np.bincount(self.ring.ravel(), self.lengths.ravel())[1:]
        self.mean = whole / np.maximum(self.numbers, 1)

    def power(self, field: Array) -> Array:
        """|sum of field exp(-i k.r)|^2 (size), over the number of sites."""
        if self.odd is None:
            sums = np.fft.fftn(field)
        else:
            sums = np.fft.fftn(np.where(self.odd, 0.0, field))
            sums = sums + self.turn * np.fft.fftn(np.where(self.odd, field, 0.0))
        return np.asarray((sums.real**2 + sums.imag**2) / field.size)

    def by_ring(self, power: Array) -> Array:
        """The mean over the wave vectors of each ring."""
        sums = np.bincount(self.ring.ravel(), power.ravel(), minlength=len(self.numbers) + 1)[1:]
        return np.asarray(sums / np.maximum(self.numbers, 1))
