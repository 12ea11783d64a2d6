"""Places outside of all bodies and walls, for particles that a step leaves in one."""

from mesokit.geometry.protocol import (
    facing,
    homed,
)
from mesokit.method.mpcd.engine.bodies.near import (
    bodies_near,
    body_near,
)
from mesokit.method.mpcd.engine.bodies.search import normal_at
from mesokit.method.mpcd.engine.bodies.state import (
    FOUR,
    PLACE,
    RADIUS,
    TURN,
    distance_of,
    image_near,
    is_nearer,
    load,
    of_kind,
)
from mesokit.method.mpcd.engine.cpu.physics import has_solid
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import seldom
from mesokit.scalar.vector import added_scaled, dot

PROJECTIONS = 8
OUTSIDE = 1e-12  # cells: how far from a surface particles are put
FREE_STEP, FREE_TRIES = 0.05, 400


@seldom
def put_outside(physics, box, bodies, cell, r):
    """The nearest place outside all bodies and walls, whether that is another one, and whether
    there is one."""
    start, moved = r, False
    # In turn out of the body and of the wall in which it is deepest. Where they touch that may go
    # on for ever, so places around are tried then, nearer ones first.
    for _ in range(PROJECTIONS):
        depth, out = deepest(box, bodies, cell, r)
        wall, away = in_wall(physics, r)
        if depth >= 0.0 and wall >= 0.0:
            return r, moved, True
        moved = True
        if depth < 0.0:
            r = added_scaled(r, OUTSIDE - depth, out)
        else:
            r = added_scaled(r, OUTSIDE - wall, away)
    for n in range(FREE_TRIES):
        r, rest = start, n % 27
        for k in range(len(r)):
            r = with_item(r, k, r[k] + FREE_STEP * (1 + n // 27) * (rest % 3 - 1.0))
            rest //= 3
        depth, _ = deepest(box, bodies, cell, r)
        wall, _ = in_wall(physics, r)
        if depth >= 0.0 and wall >= 0.0:
            return r, True, True
    return start, True, False


@seldom
def deepest(box, bodies, cell, r):
    """The least distance of r from the bodies on the list of a cell, 0 if it is in none, and the
    normal of that body."""
    least, out = 0.0, r
    for n in range(bodies_near(bodies, cell)):
        i = body_near(bodies, cell, n)
        x, _ = image_near(box, load(bodies.rows, i, PLACE, r), r)
        s = added_scaled(r, -1.0, x)
        radius = of_kind(bodies, i, RADIUS)
        if dot(s, s) < radius * radius:
            q, kind = load(bodies.rows, i, TURN, FOUR), bodies.kind[i]
            if is_nearer(bodies, kind, q, s, least):
                least, out = distance_of(bodies, kind, q, s), normal_at(bodies, i, s, 0.0)
    return least, out


@where("(0.0, r)", physics=has_solid)
def in_wall(physics, r):
    """The distance of r from walls where it is in one, else 0, and the normal out of them."""
    x = homed(physics.solid, r)
    distance, normal, _, _ = facing(physics.solid, 0.0, x)
    return min(distance, 0.0), normal
