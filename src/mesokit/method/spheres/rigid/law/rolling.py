"""Friction against rolling: a torque up to a coefficient times the reduced radius times the push.

Of two grains that roll on one another without sliding it takes the difference of their angular
velocities (Estrada, Taboada and Radjai 2008).
"""

from mesokit.method.spheres.rigid.law.coulomb import cut
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled


@scalar
def resisted(torque, inertia, turning, most):
    """The angular impulse after one update: it ends all turning, or has its largest size.

    torque: so far; inertia: reduced; turning: difference of the angular velocities with that
    impulse; most: rolling coefficient times reduced radius times the impulse along the normal.
    """
    return cut(added_scaled(torque, -inertia, turning), most)
