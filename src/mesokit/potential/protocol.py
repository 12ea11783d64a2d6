"""What a potential answers: its energy and its force, both from one place.

The first argument is the potential's NamedTuple of parameters; its class picks the implementation.
"""

from mesokit.scalar import generic


@generic
def central(potential, square):
    """Energy of two beads whose squared distance is given, and their push.

    The push times the vector from one bead to the other is the force on the other: minus the
    derivative of the energy over the distance.
    """


@generic
def torn(potential, square):
    """Whether a bond of this squared length is longer than it can be (a literal where none is)."""


@generic
def angular(potential, cosine):
    """Energy of two bonds in a row, the cosine of whose angle is given (1: straight), and its
    derivative by the cosine."""
