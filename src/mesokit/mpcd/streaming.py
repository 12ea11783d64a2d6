"""Flight of a particle through a timestep: a parabola, broken where it meets a surface."""

from mesokit.geometry.protocol import confine, first_hit, reflect
from mesokit.mpcd.field.protocol import acceleration
from mesokit.scalar import added, added_scaled, by_type, scalar, scaled

MOST_HITS = 64  # within one timestep; a corner or a grazing flight may need a few


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


@scalar
def bounce(solid, r, v, a, time):
    """Flight with reflections: position, velocity, and what surfaces 0 and 1 took of the latter."""
    lower, upper = scaled(0.0, v), scaled(0.0, v)
    for _ in range(MOST_HITS):
        hit, surface = first_hit(solid, r, v, a, time)
        if hit > time:
            break
        r, v = fall(r, v, a, hit)
        r = confine(solid, r)
        left = reflect(solid, surface, v)
        taken = added_scaled(v, -1.0, left)
        if surface == 0:
            lower = added(lower, taken)
        else:
            upper = added(upper, taken)
        v, time = left, time - hit
    r, v = fall(r, v, a, time)
    return confine(solid, r), v, lower, upper
