"""What a solid answers: whether a flight touches it, where, and what its surface does there.

The first argument is the solid's NamedTuple of parameters; its class picks the implementation. A
flight starts at r with velocity v inside the fluid and has the constant acceleration a.
"""

from mesokit.scalar import generic


@generic
def across(solid):
    """The axis that plates close, as a literal."""
    raise NotImplementedError


@generic
def touches(solid, r, v, a, time):
    """Whether the flight may touch the solid within the time (a cheap test for every particle)."""
    raise NotImplementedError


@generic
def first_hit(solid, r, v, a, time):
    """Time of the first hit (more than `time` if there is none) and the surface that is hit."""
    raise NotImplementedError


@generic
def reflect(solid, surface, v):
    """Velocity after the hit."""
    raise NotImplementedError


@generic
def confine(solid, r):
    """The nearest place in the fluid: takes off what rounding put beyond a surface."""
    raise NotImplementedError


@generic
def exposed(solid):
    """Whether there is a surface at all (a literal, so that the compiler drops what it guards)."""
    raise NotImplementedError


@generic
def closes(solid, place, shift, lower_rate, upper_rate):
    """Position and mean velocity of a virtual particle, from uniform numbers and the grid shift.

    The rates are those at which the fluid's velocity rises with the distance from surfaces 0 and 1;
    within the solid it goes on falling.
    """
    raise NotImplementedError


@generic
def side(solid, r):
    """The surface behind which a virtual particle at r lies: 0 or 1, or 2 where it must not act."""
    raise NotImplementedError
