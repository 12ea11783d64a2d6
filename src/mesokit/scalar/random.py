"""Random numbers by counter: Philox4x32-10, keyed by seed and purpose, counted by step and index.

Nothing is stored between draws, so a number depends only on what it is for, and any thread, rank or
restart finds the same one. Source: Salmon, Moraes, Dror and Shaw (2011), Parallel random numbers:
as easy as 1, 2, 3.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.scalar.elementary import short_log, short_sin, short_sincos
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import first

# What a number is for. One line each; never reuse a value, or two uses would share their numbers.
GRID_SHIFT = np.uint64(1)
CELL = np.uint64(2)  # two words for the collision rule, two for the thermostat
CELL_DOUBT = np.uint64(3)
PARTICLE_VELOCITY = np.uint64(4)
CELL_VIRTUAL = np.uint64(7)
INITIAL_POSITION = np.uint64(8)
INITIAL_VELOCITY = np.uint64(9)
VIRTUAL_POSITION = np.uint64(10)  # of virtual particles
VIRTUAL_VELOCITY = np.uint64(11)
DIFFUSE_WALL = np.uint64(12)
VIRTUAL_NUMBER = np.uint64(13)
INITIAL_SOLUTES = np.uint64(14)
INITIAL_BODIES = np.uint64(15)
BODY_GAS_NUMBER = np.uint64(16)  # of virtual particles in bodies that move
BODY_GAS_PLACE = np.uint64(17)
BODY_GAS_VELOCITY = np.uint64(18)
BODY_TUMBLE = np.uint64(19)
# Where the numbers of what is no particle of the fluid begin.
FIRST_BODY_GAS, FIRST_VIRTUAL, FIRST_BEAD = 2**60, 2**61, 2**62
METHOD = np.uint64(128)  # to 255: for methods other than MPCD, whose runs never meet

_LOW = np.uint64(0xFFFFFFFF)
_SHIFT = np.uint64(32)
_MULTIPLY_0 = np.uint64(0xD2511F53)
_MULTIPLY_1 = np.uint64(0xCD9E8D57)
_WEYL_0 = np.uint64(0x9E3779B9)
_WEYL_1 = np.uint64(0xBB67AE85)
_PURPOSE_SHIFT = np.uint64(24)
_JOIN = np.uint64(20)
_TO_UNIT_52 = 2.0**-52
_TO_UNIT_32 = 2.0**-32
_TO_UNIT_30 = 2.0**-30
_LOW_30 = np.uint64(0x3FFFFFFF)
_BIT_30 = np.uint64(1 << 30)
_BIT_31 = np.uint64(1 << 31)
_QUARTER_TURN = 0.5 * math.pi


class Counter(NamedTuple):
    """Where in the random stream a kernel stands: the run's seed and the step."""

    seed: np.uint64
    step: np.uint64


@scalar
def _round(c0, c1, c2, c3, k0, k1):
    p0 = _MULTIPLY_0 * c0
    p1 = _MULTIPLY_1 * c2
    return (p1 >> _SHIFT) ^ c1 ^ k0, p1 & _LOW, (p0 >> _SHIFT) ^ c3 ^ k1, p0 & _LOW


@scalar
def philox(c0, c1, c2, c3, k0, k1):
    """Philox4x32-10: four 32-bit words (as uint64) from a 4-word counter and a 2-word key."""
    for _ in range(9):
        c0, c1, c2, c3 = _round(c0, c1, c2, c3, k0, k1)
        k0 = (k0 + _WEYL_0) & _LOW
        k1 = (k1 + _WEYL_1) & _LOW
    return _round(c0, c1, c2, c3, k0, k1)


@scalar
def words(counter, purpose, index, draw):
    """Four random 32-bit words for one use: (seed, purpose) is the key, the rest the counter.

    `index` is the global cell or particle number, `draw` counts repeated draws for the same index.
    """
    seed = np.uint64(counter.seed)
    step = np.uint64(counter.step)
    key = (seed >> _SHIFT) | (purpose << _PURPOSE_SHIFT)
    return philox(
        np.uint64(index), np.uint64(draw), step & _LOW, step >> _SHIFT, seed & _LOW, key & _LOW
    )


@scalar
def unit(high, low):
    """Uniform number in [0, 1) with 52 random bits from two words."""
    return float(np.int64((high << _JOIN) ^ low)) * _TO_UNIT_52


@scalar
def unit_open(word):
    """Uniform number in (0, 1) from one word: the middle of one of 2^32 intervals."""
    return (float(np.int64(word)) + 0.5) * _TO_UNIT_32


@scalar
def normal_pair(a, b):
    """Two independent standard normal numbers from two words (Box and Muller 1958).

    The direction lies within an eighth of a turn of the first axis; the two last bits of its word
    swap the axes and reverse it.
    """
    radius = math.sqrt(-2.0 * short_log(unit_open(a)))
    part = (float(np.int64(b & _LOW_30)) + 0.5) * _TO_UNIT_30
    s, c = short_sincos((part - 0.5) * _QUARTER_TURN)
    swap, reverse = (b & _BIT_30) != 0, (b & _BIT_31) != 0
    radius = -radius if reverse else radius
    return radius * (s if swap else c), radius * (c if swap else s)


@scalar
def normal(a, b):
    """One of the pair: the direction may then lie in one half of the plane."""
    return math.sqrt(-2.0 * short_log(unit_open(a))) * short_sin(unit_open(b) - 0.5)


@scalar
def normals(pattern, a, b, c, d):
    """Standard normal numbers from four words, as many (2 or 3) as `pattern` has elements."""
    x, y = normal_pair(a, b)
    return first((x, y, normal(c, d)), pattern)


@scalar
def grid_shift(counter, pattern, strength):
    """Shift of the cells of one step, uniform in [-1/2, 1/2) times the strength along each axis."""
    for k in range(len(pattern)):
        a, b, _, _ = words(counter, GRID_SHIFT, k, 0)
        pattern = with_item(pattern, k, strength * (unit(a, b) - 0.5))
    return pattern
