"""Geometry of `Bodies` for virtual particles: depth, velocity of the surface, record of momentum.

Implements `geometry/cut.py`. Lengths are in cells; a term is the number of a surface.
"""

import math

from mesokit.geometry.cut import behind, grip, height, home, roomy, surface_flow
from mesokit.geometry.solids.bodies import (
    BODY,
    FILLS,
    Bodies,
    from_pivot,
    home_cell,
    in_box,
    nearest,
    part_normal,
    sure_clearance,
    surface_number,
    surface_velocity,
    term_clearance,
)
from mesokit.scalar.pointer import whole, word
from mesokit.scalar.vector import added_scaled


@behind.register(Bodies)
def _(solid, r):
    # A surface without virtual particles reports a clearance that is not negative.
    clear, part, term = nearest(solid.tables, r)
    if clear >= 0.0 or surface_number(solid.tables, term, FILLS) < 0.5:
        return abs(clear), term, r
    return clear, term, in_box(solid, added_scaled(r, -clear, part_normal(solid.tables, part, r)))


@surface_flow.register(Bodies)
def _(solid, term, r):
    return surface_velocity(solid.tables, term, r)


@height.register(Bodies)
def _(solid, term, r):
    clear, _ = term_clearance(solid.tables, term, r)
    return clear


@roomy.register(Bodies)
def _(solid, r):
    # Half the diagonal of a cell. A cheap lower bound of the clearance comes before the search.
    room = 0.5 * math.sqrt(float(len(r)))
    if sure_clearance(solid, r) >= room:
        return True
    least, _, _ = nearest(solid.tables, in_box(solid, r))
    return least >= room


@home.register(Bodies)
def _(solid, r):
    return home_cell(solid.tables, r)


@grip.register(Bodies)
def _(solid, term, r):
    return whole(word(solid.tables, BODY), term), from_pivot(solid.tables, term, r)
