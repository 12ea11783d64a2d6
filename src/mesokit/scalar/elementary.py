"""Sine, cosine and logarithm as branch-free polynomials.

The C library's versions keep a loop from being vectorised, and vector libraries round differently
from scalar ones; these give the same bits everywhere. Errors below 3e-16, unless said otherwise
(tests/execute).
"""

import math

import numpy as np

from mesokit.scalar.intrinsics import floor, mul_add
from mesokit.scalar.jit import scalar

_MANTISSA = np.int64(0x000FFFFFFFFFFFFF)
_ONE = np.int64(0x3FF0000000000000)
_LN2 = math.log(2.0)
_PER_LN2 = 1.0 / _LN2
_SQRT2 = math.sqrt(2.0)
_ROUNDER = 1.5 * 2.0**52


@scalar
def rint(x):
    """The whole number nearest to x, as a float, for |x| < 2^51; halves go to the even one."""
    return (x + _ROUNDER) - _ROUNDER


@scalar
def sincos_turn(u):
    """Sine and cosine of 2 pi u for 0 <= u <= 1 (u in turns)."""
    quarter = floor(4.0 * u + 0.5)
    x = (u - 0.25 * quarter) * 6.283185307179586
    z = x * x
    s = -1.0 / 1307674368000.0
    s = mul_add(z, s, 1.0 / 6227020800.0)
    s = mul_add(z, s, -1.0 / 39916800.0)
    s = mul_add(z, s, 1.0 / 362880.0)
    s = mul_add(z, s, -1.0 / 5040.0)
    s = mul_add(z, s, 1.0 / 120.0)
    s = mul_add(z, s, -1.0 / 6.0)
    s = mul_add(x * z, s, x)
    c = 1.0 / 20922789888000.0
    c = mul_add(z, c, -1.0 / 87178291200.0)
    c = mul_add(z, c, 1.0 / 479001600.0)
    c = mul_add(z, c, -1.0 / 3628800.0)
    c = mul_add(z, c, 1.0 / 40320.0)
    c = mul_add(z, c, -1.0 / 720.0)
    c = mul_add(z, c, 1.0 / 24.0)
    c = mul_add(z * z, c, mul_add(-0.5, z, 1.0))
    half = floor(0.5 * quarter)
    swap = quarter - 2.0 * half > 0.5
    sign = 1.0 - 2.0 * (half - 2.0 * floor(0.5 * half))
    return sign * (c if swap else s), sign * (-s if swap else c)


@scalar
def _exponent_and_ratio(x):
    """x = 2^exponent (1 + s) / (1 - s), with s as small as can be."""
    bits = np.float64(x).view(np.int64)
    exponent = float((bits >> 52) - 1023)
    m = np.int64((bits & _MANTISSA) | _ONE).view(np.float64)
    large = m > _SQRT2
    m = 0.5 * m if large else m
    exponent = exponent + 1.0 if large else exponent
    return exponent, (m - 1.0) / (m + 1.0)


@scalar
def log(x):
    """Natural logarithm of a positive normal x: exponent and atanh series of the mantissa."""
    exponent, s = _exponent_and_ratio(x)
    z = s * s
    p = 1.0 / 21.0
    p = mul_add(z, p, 1.0 / 19.0)
    p = mul_add(z, p, 1.0 / 17.0)
    p = mul_add(z, p, 1.0 / 15.0)
    p = mul_add(z, p, 1.0 / 13.0)
    p = mul_add(z, p, 1.0 / 11.0)
    p = mul_add(z, p, 1.0 / 9.0)
    p = mul_add(z, p, 1.0 / 7.0)
    p = mul_add(z, p, 1.0 / 5.0)
    p = mul_add(z, p, 1.0 / 3.0)
    return mul_add(exponent, _LN2, mul_add(2.0 * s * z, p, 2.0 * s))


# For random numbers made of 32-bit words: errors below 1e-10, with coefficients fitted for the
# least largest error (Lawson's iteration).


@scalar
def short_log(x):
    """Natural logarithm of a positive normal x."""
    exponent, s = _exponent_and_ratio(x)
    z = s * s
    p = 0.11791074835983392
    p = mul_add(z, p, 0.1426865432692728)
    p = mul_add(z, p, 0.2000016759422225)
    p = mul_add(z, p, 0.33333332822736444)
    return mul_add(exponent, _LN2, mul_add(2.0 * s * z, p, 2.0 * s))


@scalar
def short_exp(x):
    """Exponential of -700 < x < 700; relative error."""
    powers = floor(mul_add(x, _PER_LN2, 0.5))
    y = mul_add(-powers, _LN2, x)
    p = 1.0 / 362880.0
    p = mul_add(y, p, 1.0 / 40320.0)
    p = mul_add(y, p, 1.0 / 5040.0)
    p = mul_add(y, p, 1.0 / 720.0)
    p = mul_add(y, p, 1.0 / 120.0)
    p = mul_add(y, p, 1.0 / 24.0)
    p = mul_add(y, p, 1.0 / 6.0)
    p = mul_add(y, p, 0.5)
    p = mul_add(y * y, p, y) + 1.0
    bits = np.float64(powers + _ROUNDER).view(np.int64)  # the last are those of the whole number
    return p * np.int64((bits + 1023) << 52).view(np.float64)


@scalar
def short_sincos(x):
    """Sine and cosine of -pi/4 < x < pi/4."""
    z = x * x
    s = 2.718311666003157e-06
    s = mul_add(z, s, -0.0001983933485391946)
    s = mul_add(z, s, 0.008333329385944124)
    s = mul_add(z, s, -0.16666666641626995)
    c = 2.4438451551031347e-05
    c = mul_add(z, c, -0.0013887367515317492)
    c = mul_add(z, c, 0.04166664686643257)
    return mul_add(x * z, s, x), mul_add(z * z, c, mul_add(-0.5, z, 1.0))


@scalar
def short_sin(w):
    """Sine of pi w for -1/2 < w < 1/2."""
    z = w * w
    s = -0.007000500255137967
    s = mul_add(z, s, 0.08203123007687828)
    s = mul_add(z, s, -0.5992474048905253)
    s = mul_add(z, s, 2.5501627947199137)
    s = mul_add(z, s, -5.1677127412215444)
    s = mul_add(z, s, 3.141592653243754)
    return w * s
