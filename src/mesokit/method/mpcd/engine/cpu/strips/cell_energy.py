"""The kinetic energy of cells: not summed, in a column of their sums, or with the count.

A thermostat does not need the last digits. Its energy shares an integer with the number of
particles, 16 bits for the number and 48 for the energy: cells keep the width that they have without
a thermostat, which is what makes it cheap. A rule that conserves energy has a column of full width.
"""

import math
from typing import NamedTuple

import numpy as np

from mesokit.scalar.fixed_point import ROUNDER_BITS, fixed
from mesokit.scalar.jit import generic
from mesokit.scalar.vector import dot

COUNT_SHIFT = 48
ONE_PARTICLE = 1 << COUNT_SHIFT
ENERGY_MASK = ONE_PARTICLE - 1
MOST_PARTICLES = 1 << 15  # of one cell, with a factor of 2 to spare
MOST_DENSITY = 1000.0  # beyond which too few bits are left for the energy
SPARE = 2.0**16  # how much larger than thermal the energy of a cell of the mean density may get


class NotNeeded(NamedTuple):
    """No rule or thermostat needs the energy."""


class Column(NamedTuple):
    """A term of its own in the sums."""


class WithCount(NamedTuple):
    """The energy shares the integer that counts the particles; `scale`: its units per energy."""

    scale: float


def with_count(thermal: float, density: float) -> WithCount:
    """Scale with room for a cell of `SPARE` times `density` thermal energies."""
    return WithCount(2.0 ** math.floor(COUNT_SHIFT - math.log2(SPARE * thermal * density)))


@generic
def energy_term(energy, m, v):
    """The term of a particle in a column of its own: (m v^2,) or ()."""


@generic
def tally(energy, m, v):
    """The term of a particle in the integer that counts the particles: (integer,), or () for 1."""


@generic
def untangled(energy, total):
    """Number of particles, and sum of m v^2 if it is kept with it, from that integer."""


@generic
def needs_energy(energy):
    """Whether a rule or thermostat needs the energy (a literal)."""


@generic
def many_energy_term(energy, m_v_squared):
    """The term of several particles with this sum of m v^2 in a column of its own, or ()."""


@generic
def many_tally(energy, number, m_v_squared):
    """The term of so many particles in the integer that counts."""


@energy_term.register(NotNeeded, WithCount)
def _(energy, m, v):
    return ()


@energy_term.register(Column)
def _(energy, m, v):
    return (m * dot(v, v),)


@tally.register(NotNeeded, Column)
def _(energy, m, v):
    return ()


@tally.register(WithCount)
def _(energy, m, v):
    return (fixed(dot(v, v), m * energy.scale) + np.int64(ONE_PARTICLE - ROUNDER_BITS),)


@untangled.register(NotNeeded, Column)
def _(energy, total):
    return total, 0.0


@untangled.register(WithCount)
def _(energy, total):
    number = np.int64(np.uint64(total) >> np.uint64(COUNT_SHIFT))
    return number, float(total & np.int64(ENERGY_MASK)) * (1.0 / energy.scale)


@needs_energy.register(NotNeeded)
def _(energy):
    return False


@needs_energy.register(Column, WithCount)
def _(energy):
    return True


@many_energy_term.register(NotNeeded, WithCount)
def _(energy, m_v_squared):
    return ()


@many_energy_term.register(Column)
def _(energy, m_v_squared):
    return (m_v_squared,)


@many_tally.register(NotNeeded, Column)
def _(energy, number, m_v_squared):
    return np.int64(number)


@many_tally.register(WithCount)
def _(energy, number, m_v_squared):
    return np.int64(number) * ONE_PARTICLE + fixed(m_v_squared, energy.scale) - ROUNDER_BITS
