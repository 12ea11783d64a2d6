"""Friction of Coulomb: surfaces stick with an impulse up to mu times that along the normal."""

from mesokit.method.spheres.rigid.law.frame import no_longer
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.vector import added_scaled


@scalar
def dragged(drag, mass, sliding, most):
    """The impulse along the surface after one update: it ends all sliding, or has its largest size.

    drag: so far; mass: of the surfaces along one another; sliding: velocity with that impulse;
    most: friction coefficient times the impulse along the normal.
    """
    return cut(added_scaled(drag, -mass, sliding), most)


@by_type
def cut(vector, most):
    """A vector cut back to a length."""
    if len(vector) == 1:
        return lambda vector, most: (min(max(vector[0], -most), most),)
    return lambda vector, most: no_longer(vector, most)
