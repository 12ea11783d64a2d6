"""What cells add up over their particles: their number, and fixed-point numbers."""

# ruff: noqa: F401  lines written out as text use what is imported here

import numpy as np

from mesokit.execute.cell_energy import Column, energy_term, untangled
from mesokit.execute.fixed_point import from_fixed, integers, rounded
from mesokit.scalar import by_type, elementwise, scalar, scaled


@scalar
def nothing_found(terms):
    """The sums of a cell without particles: their number, and so many terms."""
    return (np.int64(0),) + integers(terms)


@scalar
def terms_of(physics, m, v, own, scales):
    """What a particle adds to the sums of its cell; `own` is for those of the collision rule."""
    terms = scaled(m, v) + _mass_term(physics.masses, m) + energy_term(physics.energy, m, v) + own
    return rounded(terms, scales)


@by_type
def _mass_term(masses, m):
    """(m,) where particles differ in mass, so that cells must add it up; () where they do not."""
    if len(masses) == 1:
        return lambda masses, m: ()
    return lambda masses, m: (m,)


@by_type
def read_sums(masses, energy, found, like, scales):
    """Number, mass, momentum, sum of m v^2 (0 if not asked) and the rule's own sums of a cell."""
    d, uniform, asked = len(like), len(masses) == 1, energy.instance_class is Column
    at_energy = d if uniform else d + 1
    own = at_energy + 1 if asked else at_energy

    def read(masses, energy, found, like, scales):
        n, with_count = untangled(energy, found[0])
        values = _floats(n, found, scales)
        mass = max(float(n), 1.0) * masses[0] if uniform else max(values[d], 1e-300)
        m_v_squared = values[at_energy] if asked else with_count
        return float(n), mass, values[:d], m_v_squared, values[own:]

    return read


@elementwise
def _floats(n, found, scales):
    """The sums of n particles as floats."""
    return "from_fixed(found[{k} + 1], n, scales[{k}])"
