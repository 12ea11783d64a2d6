"""Flight of a particle through a timestep: a parabola."""

from mesokit.method.mpcd.field.protocol import acceleration
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.vector import added_scaled, scaled


@by_type
def fall(r, v, a, time):
    """Position and velocity after a time of constant acceleration a, which may be ()."""
    if len(a) == 0:
        return lambda r, v, a, time: (added_scaled(r, time, v), v)

    def parabola(r, v, a, time):
        mean = added_scaled(v, 0.5 * time, a)
        return added_scaled(r, time, mean), added_scaled(v, time, a)

    return parabola


@by_type
def vector(a, like):
    """The acceleration as a vector, also where it is ()."""
    if len(a) == 0:
        return lambda a, like: scaled(0.0, like)
    return lambda a, like: a


@scalar
def halfway(field, r, v, time):
    """Acceleration at the middle of the straight flight."""
    return acceleration(field, added_scaled(r, 0.5 * time, v))
