"""Velocities and impulses of a contact in its own frame: along the normal, and along the surface.

In 2D the part along the surface is one number, along the normal turned by a quarter; in 3D it is a
vector. Angular velocities are multiplied by the radius, so that radii do not enter.
"""

from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.vector import added_scaled, dot, outer, scaled


@by_type
def sliding(normal, velocity, rolled):
    """Velocity of the surfaces along one another.

    velocity: of the one centre relative to the other; rolled: sum of radius times angular velocity.
    """
    if len(normal) == 2:
        return _sliding_in_plane
    return _sliding_in_space


def _sliding_in_plane(normal, velocity, rolled):
    return (normal[0] * velocity[1] - normal[1] * velocity[0] - rolled[0],)


def _sliding_in_space(normal, velocity, rolled):
    at_contact = added_scaled(velocity, -1.0, outer(rolled, normal))
    return added_scaled(at_contact, -dot(normal, velocity), normal)


@by_type
def impulse(normal, push, drag):
    """The impulse on the one grain, from its parts along the normal and along the surface."""
    if len(normal) == 2:
        return _impulse_in_plane
    return lambda normal, push, drag: added_scaled(drag, push, normal)


def _impulse_in_plane(normal, push, drag):
    return (push * normal[0] - drag[0] * normal[1], push * normal[1] + drag[0] * normal[0])


@by_type
def turn(normal, drag):
    """The normal times the impulse along the surface, as vectors: minus the torque per radius."""
    if len(normal) == 2:
        return lambda normal, drag: drag
    return lambda normal, drag: outer(normal, drag)


@by_type
def parts(normal, whole):
    """An impulse in parts: along the normal, and along the surface."""
    if len(normal) == 2:
        return _parts_in_plane
    return _parts_in_space


def _parts_in_plane(normal, whole):
    return dot(normal, whole), (normal[0] * whole[1] - normal[1] * whole[0],)


def _parts_in_space(normal, whole):
    push = dot(normal, whole)
    return push, added_scaled(whole, -push, normal)


@scalar
def no_longer(vector, most):
    """A vector, or one no longer than `most` along it."""
    square = dot(vector, vector)
    if square > most * most:
        return scaled(most / square**0.5, vector)
    return vector
