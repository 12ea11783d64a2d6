"""Geometry of a solid for virtual particles: depth, velocity of the surface, record of momentum.

The first argument is the solid's NamedTuple of parameters; its class picks the implementation. A
term is the number by which the solid knows one of its surfaces. Places are homed (see `protocol`).
"""

from mesokit.scalar.jit import generic


@generic
def behind(solid, r):
    """Clearance of r, which is negative in solid, the term there, and the nearest place on it.

    Where the surface holds no virtual particles, the clearance is not negative either.
    """


@generic
def surface_flow(solid, term, r):
    """Velocity of the surface of a term at r."""


@generic
def height(solid, term, r):
    """Distance of r from the surface of a term, positive in the fluid."""


@generic
def roomy(solid, r):
    """Whether the unit cell about r is surely free of solid."""


@generic
def home(solid, r):
    """Number of the unit cell of the box that holds r."""


@generic
def grip(solid, term, r):
    """The number by which momentum is kept for the surface of a term, and r from its pivot."""
