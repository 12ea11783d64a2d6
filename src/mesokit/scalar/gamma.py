"""Gamma variates: of the energy of so many degrees of freedom.

Source: Marsaglia and Tsang (2000), A simple method for generating gamma variables, section 2.
"""

import math

import numpy as np

from mesokit.scalar.elementary import log
from mesokit.scalar.intrinsics import mul_add
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.random import normal, unit_open, words

LAST_BITS = np.uint64(4095)
DOUBT = 1 << 16
MOST_DRAWS = 1000  # each accepted with more than 95 %


@scalar
def propose(a, b, freedom):
    """A candidate for a gamma variate of shape freedom / 2.

    Gives the candidate and what decides on it: the normal number x, e, 1 / sqrt(9 e), and
    t = 1 + x / sqrt(9 e). Shape 1/2 (two particles of a rule +a) is half the square of x, to be
    taken as it is; e is then 0. So is shape 0, which gives 0.
    """
    x = normal(a, b)
    shape = 0.5 * freedom
    large = shape > 0.75
    e = shape - 1.0 / 3.0 if large else 1.0
    width = 1.0 / math.sqrt(9.0 * e)
    t = mul_add(x, width, 1.0)
    small = 0.5 * x * x if shape > 0.25 else 0.0
    return e * (t * t * t) if large else small, x, e if large else 0.0, width, t


@scalar
def part(b):
    """Which of 4096 equal parts of (0, 1) the number u of the test lies in.

    These bits of a word are also the last ones of x, where they move it by less than 1e-5.
    """
    return float(np.int64(b & LAST_BITS))


@scalar
def likely(a, b, freedom):
    """A gamma variate of shape freedom / 2 from two words, and whether it may surely be used.

    Sure where all of u's part is below a bound on what the test compares it to. The test is
    log u < f, where with y = x / sqrt(9 e) f is -e times the integral of 3 s^3 / (1 + s) from 0 to
    y; for y > -1/2 it is at least -z, z = 3/4 e y^4 max(1, 1 - 2 y), as 1 / (1 + y) < 1 - 2 y for
    negative y. And log u < -z where u < 1 - z.
    """
    value, x, e, width, t = propose(a, b, freedom)
    square = x * x * width
    z = square * square * max(3.0 - 2.0 * t, 1.0) / 12.0
    below = 4096.0 * (1.0 - z)
    return value, (t > 0.5 and part(b) + 1.0 < below) or e == 0.0


@scalar
def decided(a, b, c, freedom):
    """The same with the test itself, for which a third word says where in its part u lies."""
    value, x, e, _, t = propose(a, b, freedom)
    u = (part(b) + unit_open(c)) / 4096.0
    cube = max(t * t * t, 1e-300)
    accepted = t > 0.0 and log(u) < 0.5 * x * x + e - e * cube + e * log(cube)
    return value, accepted or e == 0.0


@seldom
def gamma_number(freedom, counter, purpose, index):
    """A gamma variate of shape freedom / 2: energy over kT of so many degrees of freedom.

    Uses the third and fourth word of draws 0, 1, ... and the first of those from DOUBT on.
    """
    value, good, attempt = 0.0, False, 0
    while not good and attempt < MOST_DRAWS:
        _, _, a, b = words(counter, purpose, index, attempt)
        c, _, _, _ = words(counter, purpose, index, DOUBT + attempt)
        value, good = decided(a, b, c, freedom)
        attempt += 1
    return value
