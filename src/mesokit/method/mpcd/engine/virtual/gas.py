"""Virtual particles are a thermal gas, and surfaces take the momentum that they gain."""

import math

from mesokit.geometry.cut import grip
from mesokit.method.mpcd.engine.cpu.bounce import take
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import normals, words
from mesokit.scalar.vector import scaled


@scalar
def thermal(physics, m, counter, purpose, number, draw):
    """The velocity of a particle of mass m of a gas at rest."""
    a, b, c, d = words(counter, purpose, number, draw)
    return scaled(math.sqrt(physics.kT / m), normals(physics.zero, a, b, c, d))


@scalar
def body_takes(impulse, solid, term, r, p, scale):
    """Add the momentum p, taken at r, to what the surface of a term took."""
    surface, lever = grip(solid, term, r)
    take(impulse, surface, lever, p, scale)
