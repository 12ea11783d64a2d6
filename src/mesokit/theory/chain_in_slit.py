"""Where the beads of ideal molecules are between two hard walls."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive

Floats = NDArray[np.float64]
FINE = 3.0  # points of the grid in one spread of a bond, at least
MOST_POINTS = 2000  # the work grows with their square


def beads_in_slit(
    edges: ArrayLike, links: Sequence[Sequence[int]], spread: float, decay: float = 0.0
) -> Floats:
    """Density of each bead of an ideal molecule across a slit, (beads, bins), 1 in the mean.

    A bond is Gaussian, and a bead may be anywhere but in a wall. So bead i is at y with the weight
    of all that hangs on it: a product of one factor for each of its bonds, each the integral over
    the slit of the bond's Gaussian times the weight of what hangs on its other end.

    Parameters:
        edges: (bins + 1,) of the bins, the first and last those of the slit.
        links: pairs of beads, the second one new in each; in a ring a last pair leads back to 0.
        spread: standard deviation of a bond along the axis, sqrt(kT/k) for U = (k/2) r^2.
        decay: each bead has the weight exp(decay y) besides, of a force kT decay along the axis.

    Raises ValueError for a value out of range, and for a slit of so many spreads that the grid
    would need more than 2000 points. Source: S. F. Edwards, Proc. Phys. Soc. 85, 613 (1965), for
    discrete chains. Exact for harmonic bonds and beads that feel nothing but bonds and walls; found
    by quadrature, to 1e-6.

    >>> beads_in_slit([0, 0.5, 1], [(0, 1)], spread=1.0).round(4).tolist()
    [[1.0, 1.0], [1.0, 1.0]]
    """
    grid = _grid(edges, spread, decay)
    beads = 1 + max(max(pair) for pair in links)
    if len(links) == beads:  # a ring: the diagonal of as many bonds one after the other
        root = np.sqrt(grid.factor * grid.weight)
        values, vectors = np.linalg.eigh(root[:, None] * (grid.bond / grid.weight) * root)
        of_bead = vectors**2 @ (values / values[-1]) ** beads / grid.weight
        every = np.tile(of_bead, (beads, 1))
    else:
        weights, sums = _inwards(grid, links, np.ones((1, len(grid.y))))
        outside = [np.ones(len(grid.y))] * beads
        for a, b in links:
            rest = outside[a] * weights[a][0] / sums[b][0]
            outside[b] = (rest[None] @ grid.bond.T)[0]
            outside[b] /= outside[b].max()
        every = np.stack([o * w[0] for o, w in zip(outside, weights, strict=True)])
    return grid.binned(every)


def centre_in_slit(
    edges: ArrayLike, links: Sequence[Sequence[int]], spread: float, decay: float = 0.0
) -> Floats:
    """Density of the centre of mass of an ideal chain or star in a slit, (bins,), 1 in the mean.

    Its Fourier coefficients are <exp(i k Y)>, Y the mean of all y: the same sums as for the beads
    with the weight exp(i k y/N) at each. Parameters, errors and source as in `beads_in_slit`; not
    for rings (ValueError). Good to some 1e-4 of the mean.

    >>> centre_in_slit([0, 0.5, 1, 1.5, 2], [(0, 1)], spread=1.0).round(2).tolist()
    [0.6, 1.4, 1.4, 0.6]
    """
    beads = 1 + max(max(pair) for pair in links)
    if len(links) == beads:
        raise ValueError("links: a ring; expected a chain or star")
    edges = np.asarray(edges, float)
    low, height = edges[0], edges[-1] - edges[0]
    k = 2 * np.pi / height * np.arange(2 * len(edges) + 64)
    grid = _grid(edges, spread, decay, k[-1] / beads)
    phases = np.exp(1j * np.outer(k, grid.y - low) / beads)
    weights, _ = _inwards(grid, links, phases)
    mean = weights[0] @ grid.weight
    middle = 0.5 * (grid.edges[1:] + grid.edges[:-1]) - low
    waves = np.exp(-1j * np.outer(middle, k[1:]))
    waves *= np.sinc(np.outer(np.diff(grid.edges), k[1:]) / (2 * np.pi))
    return np.asarray(1 + 2 * (waves @ (mean[1:] / mean[0])).real)


class _Grid(NamedTuple):
    """Points `y` (M,) of a quadrature with `weight`, so many in each bin; `bond` (M, M) with the
    weights in it; `factor` (M,) of a bead."""

    edges: Floats
    y: Floats
    weight: Floats
    bond: Floats
    factor: Floats

    def binned(self, density: Floats) -> Floats:
        """Averages in bins of densities (n, M), 1 in the mean."""
        per_bin = (density * self.weight).reshape(len(density), len(self.edges) - 1, -1).sum(axis=2)
        share = per_bin / per_bin.sum(axis=1, keepdims=True)
        return np.asarray(share * (self.edges[-1] - self.edges[0]) / np.diff(self.edges))


def _grid(edges: ArrayLike, spread: float, decay: float, wave: float = 0.0) -> _Grid:
    """So fine that Gaussians of this spread, and waves of this wave number, are smooth on it."""
    positive(spread=spread)
    edges = np.asarray(edges, float)
    width = np.diff(edges)
    points = 3 + math.ceil(width.max() * max(FINE / spread, 0.5 * wave))
    if points * len(width) > MOST_POINTS:
        raise ValueError(
            f"spread = {spread!r}: expected more than {FINE * np.ptp(edges) / MOST_POINTS:.3g} in "
            f"this slit, and at most {MOST_POINTS // 3} bins"
        )
    nodes, weights = np.polynomial.legendre.leggauss(points)
    y = (edges[:-1, None] + 0.5 * width[:, None] * (1 + nodes)).ravel()
    weight = (0.5 * width[:, None] * weights).ravel()
    bond = np.exp(-0.5 * ((y[:, None] - y) / spread) ** 2) * weight
    return _Grid(edges, y, weight, bond, np.exp(decay * (y - edges[-1 if decay > 0 else 0])))


def _inwards(
    grid: _Grid, links: Sequence[Sequence[int]], phases: NDArray
) -> tuple[list[NDArray], dict[int, NDArray]]:
    """Weight (K, M) of each bead with all that hangs on it away from bead 0, and its sum over the
    bond inwards; all to a factor that is the same for every k."""
    beads = 1 + max(max(pair) for pair in links)
    weights: list[NDArray] = [grid.factor * phases for _ in range(beads)]
    sums: dict[int, NDArray] = {}
    for a, b in reversed(links):
        sums[b] = weights[b] @ grid.bond.T  # over the place of the other end
        sums[b] /= np.abs(sums[b][0]).max()
        weights[a] = weights[a] * sums[b]
    return weights, sums
