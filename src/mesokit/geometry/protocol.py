"""Functions that each kind of solid implements: hits of flights, and depths of virtual particles.

The first argument is the solid's NamedTuple of parameters; its class picks the implementation. A
flight starts at r with velocity v inside the fluid and has the constant acceleration a. A term is
the number of one surface of the solid.
"""

from typing import NamedTuple

import numpy as np

from mesokit.scalar.jit import generic


class Chance(NamedTuple):
    """Random stream, particle, hit, and kT over mass, on which a random reflection depends."""

    seed: np.uint64
    step: np.uint64
    number: int
    hit: int
    kT_over_m: float


@generic
def exposed(solid):
    """Whether there is a surface at all (a literal, so that the compiler drops what it guards)."""


@generic
def touches(solid, clear, r, v, a, time):
    """Whether the flight may touch the solid within the time (a cheap test for every particle).

    For solids in tables `clear` is (square of the distance that is clear around r,), or () where
    a stride is clear; for others it is ().
    """


@generic
def leaps(solid, displacement):
    """Whether a displacement is longer than a stride, for solids in tables: `clear` may fail."""


@generic
def free(solid, r, v, a, time):
    """Whether the flight surely misses the solid (a closer look than `touches`)."""


@generic
def homed(solid, r):
    """The image of r from which `first_hit` and the others below can tell."""


@generic
def unmet(solid):
    """The contact of a flight that starts away from all surfaces."""


@generic
def first_hit(solid, r, v, a, time, last):
    """Time of the first hit (more than `time` if there is none), and the contact: what is hit.

    The flight starts from the last contact.
    """


@generic
def happens(solid, contact):
    """Whether a contact is one, or only the end of what could be seen ahead."""


@generic
def surface_of(solid, contact):
    """Number of the surface that is hit: momentum is kept for each."""


@generic
def lever(solid, contact, r):
    """r relative to the place about which torques on that surface are taken."""


@generic
def rebound(solid, contact, r, v, chance):
    """Place and velocity after the hit.

    The place is the nearest one in the fluid: that takes off what rounding put beyond the surface.
    """


@generic
def settled(solid, r):
    """A place in the fluid within rounding of r, and whether there is one."""


@generic
def facing(solid, away, r):
    """Distance of r from the nearest surface, the normal out of it, its number, and r from its
    pivot; the first is at least `away` where nothing is nearer."""


# For virtual particles: r is an image that `homed` gives.


@generic
def nearest_surface(solid, r):
    """Clearance of r, which is negative in solid, the term there, and the nearest place on it.

    Where the surface holds no virtual particles, the clearance is not negative either.
    """


@generic
def surface_flow(solid, term, r):
    """Velocity of the surface of a term at r."""


@generic
def distance_above(solid, term, r):
    """Distance of r from the surface of a term, positive in the fluid."""


@generic
def is_clear_cell(solid, r):
    """Whether the unit cell about r is surely free of solid."""


@generic
def unit_cell(solid, r):
    """Number of the unit cell of the box that holds r."""


@generic
def surface_and_lever(solid, term, r):
    """The number by which momentum is kept for the surface of a term, and r from its pivot."""


class Nothing(NamedTuple):
    """No solid: the whole box is fluid."""


@exposed.register(Nothing)
def _(solid):
    return False


@touches.register(Nothing)
def _(solid, clear, r, v, a, time):
    return False
