"""Waves that fit a periodic box, in shells of about one length."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mesokit.seam.result import Array
from mesokit.statistics import spread_ids

MOST = 2**20  # of which shells are made
CHUNK = 2**20  # phases at once


def reachable(size: Sequence[float]) -> float:
    """The length of a wave vector up to which there are MOST in a box."""
    d = len(size)
    ball = math.pi if d == 2 else 4.0 / 3.0 * math.pi
    each = math.prod(2 * math.pi / length for length in size)
    return float((2 * MOST * each / ball) ** (1 / d))


def wave_shells(size: Sequence[float], largest: float, shells: int, most: int) -> list[Array]:
    """Wave vectors (K, d) of each of so many shells of equal width, but for those that are empty.

    Of q and -q there is one. At most so many in a shell, evenly spread over all.

    >>> [len(shell) for shell in wave_shells([10, 10], 1.0, 3, 50)]  # 0.63; 0.89
    [2, 2]
    """
    longest = [int(largest * length / (2 * math.pi)) for length in size]
    axes = [np.arange(0 if k == 0 else -n, n + 1) for k, n in enumerate(longest)]
    whole = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(size))
    whole = whole[_first_half(whole)]
    vectors = 2 * np.pi * whole / np.array(size, float)
    length = np.sqrt((vectors**2).sum(axis=1))
    place = np.ceil(length / largest * shells - 1e-9).astype(int) - 1
    order = np.argsort(place, kind="stable")
    bounds = np.searchsorted(place[order], np.arange(shells + 1))
    members = (order[low:high] for low, high in itertools.pairwise(bounds))
    return [vectors[one[spread_ids(most, len(one))]] for one in members if len(one)]


def amplitudes(r: Array, waves: Array) -> NDArray[np.complex128]:
    """Sum over the beads of e^(-i q r), (molecules, K), of molecules (molecules, length, d)."""
    found = np.empty((len(r), len(waves)), complex)
    step = max(1, CHUNK // (r.shape[1] * len(waves)))
    for start in range(0, len(r), step):
        phase, here = r[start : start + step] @ waves.T, slice(start, start + step)
        found.real[here] = np.cos(phase).sum(axis=1)  # in half the time of a complex exponential
        found.imag[here] = -np.sin(phase).sum(axis=1)
    return found


def _first_half(whole: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Those of which the first component that is not 0 is above 0."""
    chosen, zero = np.zeros(len(whole), bool), np.ones(len(whole), bool)
    for component in whole.T:
        chosen |= zero & (component > 0)
        zero &= component == 0
    return chosen
