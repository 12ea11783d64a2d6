"""From the energy of an angle to the forces on its three beads."""

import math

from mesokit.potential.protocol import angular
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled, dot, scaled

NO_LENGTH = 1e-24  # square of a length below which a bond has no direction


@scalar
def bend(potential, a, b):
    """Energy of the bonds a and then b, and the forces on the first and on the last bead.

    The bead between them feels the opposite of their sum.
    """
    aa, bb = max(dot(a, a), NO_LENGTH), max(dot(b, b), NO_LENGTH)
    both = 1.0 / math.sqrt(aa * bb)
    cosine = dot(a, b) * both
    energy, slope = angular(potential, cosine)
    first = scaled(slope, added_scaled(scaled(both, b), -cosine / aa, a))
    last = scaled(-slope, added_scaled(scaled(both, a), -cosine / bb, b))
    return energy, first, last
