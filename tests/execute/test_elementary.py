"""Our sine, cosine and logarithm: accurate, and the same bits in any loop."""

import math
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from mesokit.scalar.elementary import log, short_log, short_sin, short_sincos, sincos_turn
from mesokit.scalar.fixed_point import fixed, from_fixed, quanta

EPSILON = float(np.finfo(float).eps)


@njit
def in_a_loop(u, sines, cosines, logs):
    for i in range(len(u)):
        sines[i], cosines[i] = sincos_turn(u[i])
        logs[i] = log(u[i] + 1e-300)


PI = Decimal("3.14159265358979323846264338327950288419716939937511")


def exact_sine(turns):
    """sin(2 pi turns) by its series, to 40 digits."""
    x = 2 * PI * turns
    total, term, n = Decimal(0), x, 1
    while abs(term) > Decimal("1e-40"):
        total += term
        term *= -x * x / ((n + 1) * (n + 2))
        n += 2
    return total


@given(u=st.floats(0, 1))
@settings(max_examples=300)
def test_sine_and_cosine_of_a_turn(u):
    with localcontext(prec=50):
        s, c = sincos_turn(u)
        assert abs(Decimal(s) - exact_sine(Decimal(u))) < 3e-16
        assert abs(Decimal(c) - exact_sine(Decimal(u) + Decimal("0.25"))) < 3e-16


@pytest.mark.parametrize("eighths", range(9))
def test_sine_and_cosine_at_eighths(eighths):
    s, c = sincos_turn(eighths / 8)
    assert s == pytest.approx(math.sin(math.pi * eighths / 4), abs=3e-16)
    assert c == pytest.approx(math.cos(math.pi * eighths / 4), abs=3e-16)


@given(x=st.floats(1e-300, 1e300) | st.floats(0.5, 2.0))
@settings(max_examples=500)
def test_logarithm(x):
    with localcontext(prec=40):
        exact = Decimal(x).ln()
        assert abs(Decimal(log(x)) - exact) <= 3 * Decimal(EPSILON) * abs(exact)


def test_short_polynomials_are_as_exact_as_32_bit_words():
    u = (np.arange(0, 2**32, 99_991) + 0.5) / 2**32
    logs, sines, pairs = (
        np.array([f(x) for x in values])
        for f, values in (
            (short_log, u),
            (short_sin, u - 0.5),
            (short_sincos, (u - 0.5) * math.pi / 2),
        )
    )
    assert abs(logs - np.log(u)).max() < 1e-10
    assert abs(sines - np.sin(np.pi * (u - 0.5))).max() < 1e-10
    assert abs(pairs[:, 0] - np.sin((u - 0.5) * math.pi / 2)).max() < 1e-10
    assert abs(pairs[:, 1] - np.cos((u - 0.5) * math.pi / 2)).max() < 1e-10


@pytest.mark.parametrize("count", [1, 2, 3, 5, 7, 8, 31, 64, 255, 257, 1001])
def test_a_loop_gives_the_bits_of_single_calls(count):
    """Vectorised bodies and their scalar tails round alike, wherever the loop ends."""
    u = np.random.default_rng(count).random(count)
    got = np.empty((3, count))
    in_a_loop(u, *got)
    single = np.array([(*sincos_turn(x), log(x + 1e-300)) for x in u]).T
    np.testing.assert_array_equal(got, single)


HALVES = st.integers(-(2**51), 2**51).map(lambda n: n + 0.5)
LARGE = st.floats(-(2.0**62), 2.0**62)


@given(x=st.floats(-1e6, 1e6) | HALVES | LARGE, bits=st.integers(-10, 0))
@settings(max_examples=500)
def test_quanta_are_the_nearest_whole_numbers(x, bits):
    """Halves go to the even one."""
    assert quanta(x, 2.0**bits) == round(Fraction(x) * Fraction(2) ** bits)


def test_fixed_point_numbers_are_rounded_without_bias():
    x = np.random.default_rng(3).normal(size=20_000)
    scale = 2.0**20  # coarse, so that rounding shows
    back = np.array([from_fixed(fixed(value, scale), 1, scale) for value in x])
    error = (back - x) * scale
    assert abs(error).max() <= 0.5
    assert abs(error.mean()) < 4 / np.sqrt(12 * len(x))
    total = np.array([fixed(value, scale) for value in x]).sum()  # wraps, as the cell sums may
    assert from_fixed(total, len(x), scale) == pytest.approx(back.sum(), abs=1e-9)
