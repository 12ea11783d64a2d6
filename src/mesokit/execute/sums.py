"""What cells add up over their particles: fixed-point numbers.

Integer sums do not depend on the order of the terms. Adding 1.5 * 2^52 leaves the rounded number in
the low bits of the mantissa; the constant's own bits, once for each particle, are taken off when
the sum is read.
"""

import numpy as np

from mesokit.scalar import by_type, dot, elementwise, mul_add, scalar, scaled

ROUNDER = 1.5 * 2.0**52
ROUNDER_BITS = int(np.float64(ROUNDER).view(np.int64))


@scalar
def fixed(x, scale):
    """x * scale rounded to a whole number, plus ROUNDER_BITS, as int64."""
    return np.float64(mul_add(x, scale, ROUNDER)).view(np.int64)


@scalar
def from_fixed(total, terms, scale):
    """A sum of `terms` fixed-point numbers as a float."""
    return float(total - np.int64(terms) * ROUNDER_BITS) * (1.0 / scale)


@elementwise
def rounded(terms, scales):
    """Each term as a fixed-point number."""
    return "fixed(terms[{k}], scales[{k}])"


@elementwise
def integers(values):
    """A tuple of int64 zeros as long as `values`."""
    return "np.int64(0)"


@scalar
def nothing_found(terms):
    """The sums of a cell without particles: their number, and so many terms."""
    return (np.int64(0),) + integers(terms)


@scalar
def terms_of(physics, m, v, own, scales):
    """What a particle adds to the sums of its cell; `own` is for those of the collision rule."""
    terms = scaled(m, v) + _mass_term(physics.masses, m) + _energy_term(physics.energy, m, v) + own
    return rounded(terms, scales)


@by_type
def _mass_term(masses, m):
    """(m,) where particles differ in mass, so that cells must add it up; () where they do not."""
    if len(masses) == 1:
        return lambda masses, m: ()
    return lambda masses, m: (m,)


@by_type
def _energy_term(energy, m, v):
    """(m v^2,) where cells must know their energy; () where they need not."""
    if len(energy) == 1:
        return lambda energy, m, v: (m * dot(v, v),)
    return lambda energy, m, v: ()


@by_type
def read_sums(masses, energy, found, like, scales):
    """Number, mass, momentum, sum of m v^2 (0 if not asked) and the rule's own sums of a cell."""
    d, uniform, asked = len(like), len(masses) == 1, len(energy) == 1
    at_energy = d if uniform else d + 1
    own = at_energy + 1 if asked else at_energy

    def read(masses, energy, found, like, scales):
        n = found[0]
        values = _floats(n, found, scales)
        mass = max(float(n), 1.0) * masses[0] if uniform else max(values[d], 1e-300)
        m_v_squared = values[at_energy] if asked else 0.0
        return float(n), mass, values[:d], m_v_squared, values[own:]

    return read


@elementwise
def _floats(n, found, scales):
    """The sums of n particles as floats."""
    return "from_fixed(found[{k} + 1], n, scales[{k}])"
