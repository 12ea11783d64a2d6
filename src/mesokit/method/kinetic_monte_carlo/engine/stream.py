"""Further random numbers of an event, as many as it takes, from one random word.

They cost less than those by counter (Steele, Lea and Flood 2014, SplitMix64).
"""

import numpy as np

from mesokit.scalar.jit import scalar

_STEP, _TO_UNIT = np.uint64(0x9E3779B97F4A7C15), 2.0**-53
_MIX_1, _MIX_2 = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
_30, _27, _31, _11 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)


@scalar
def next_word(stream):
    """The next word of a stream, and the stream after it."""
    stream += _STEP
    x = (stream ^ (stream >> _30)) * _MIX_1
    x = (x ^ (x >> _27)) * _MIX_2
    return x ^ (x >> _31), stream


@scalar
def unit_of(word):
    """Uniform number in [0, 1) with the 53 highest bits of a word."""
    return np.float64(np.int64(word >> _11)) * _TO_UNIT
