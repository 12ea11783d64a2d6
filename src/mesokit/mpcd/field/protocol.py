"""What a body force answers: the acceleration at a place.

The first argument is the field's NamedTuple of parameters; its class picks the implementation. The
streaming step takes the acceleration at the middle of the straight flight and keeps it for the
timestep: exact for a uniform field, second order in the timestep for others.
"""

from mesokit.scalar import generic


@generic
def acceleration(field, r):
    """Acceleration of a particle at r, or () for none."""
