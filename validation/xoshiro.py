"""xoshiro256++ of Blackman and Vigna (2019), only to be compared: its state is a sequence."""

from __future__ import annotations

import numba
import numpy as np

# first outputs from the state 1, 2, 3, 4, as the reference implementation gives them
REFERENCE = (
    41943041, 58720359, 3588806011781223, 3591011842654386, 9228616714210784205,
    9973669472204895162, 14011001112246962877, 12406186145184390807, 15849039046786891736,
    10450023813501588000,
)  # fmt: skip


@numba.njit(cache=True)
def rotated(x, k):
    """x turned left by k of its 64 bits."""
    return (x << np.uint64(k)) | (x >> np.uint64(64 - k))


@numba.njit(cache=True)
def outputs(state, number):
    """The next numbers of 64 bits; the state (4,) moves on."""
    found = np.empty(number, np.uint64)
    for i in range(number):
        found[i] = rotated(state[0] + state[3], 23) + state[0]
        t = state[1] << np.uint64(17)
        state[2] ^= state[0]
        state[3] ^= state[1]
        state[1] ^= state[2]
        state[0] ^= state[3]
        state[2] ^= t
        state[3] = rotated(state[3], 45)
    return found


def seeded(seed: int) -> np.ndarray:
    """A state from a seed, by SplitMix64 as its authors advise."""
    state, x, mask = np.empty(4, np.uint64), seed, 2**64 - 1
    for i in range(4):
        x = (x + 0x9E3779B97F4A7C15) & mask
        z = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        state[i] = z ^ (z >> 31)
    return state


def uniforms(state: np.ndarray, number: int) -> np.ndarray:
    """The next numbers from [0, 1), of 53 bits."""
    return (outputs(state, number) >> np.uint64(11)) * 2.0**-53
