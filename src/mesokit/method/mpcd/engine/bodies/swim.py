"""The velocity of the surface of a squirmer along itself."""

from mesokit.method.mpcd.engine.bodies.state import (
    B1,
    B2,
    FOUR,
    HALF_LENGTH,
    TURN,
    load,
    of_kind,
    rotated,
)
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar, seldom
from mesokit.scalar.vector import added_scaled, dot, scaled


@scalar
def heading(bodies, i, pattern):
    """The axis x of body i, in the box."""
    axis = with_item(scaled(0.0, pattern), 0, 1.0)
    return rotated(load(bodies.rows, i, TURN, FOUR), axis)


@seldom
def squirming(bodies, i, s, normal):
    """-(B1 + B2 z) (e - (e n) n), with the axis e and the height z along it, from -1 to 1.

    On a sphere that is (B1 + B2 cos theta) sin theta along e_theta; in 2D B2 counts twice, for
    sin 2 theta (Blake 1971). Of a spheroid see Theers, Westphal, Gompper and Winkler (2016).
    """
    first, second = of_kind(bodies, i, B1), of_kind(bodies, i, B2)
    if first == 0.0 and second == 0.0:
        return scaled(0.0, s)
    e = heading(bodies, i, s)
    height = min(max(dot(s, e) / of_kind(bodies, i, HALF_LENGTH), -1.0), 1.0)
    speed = first + (2.0 if len(s) == 2 else 1.0) * second * height
    along = added_scaled(e, -dot(e, normal), normal)
    return scaled(-speed, along)
