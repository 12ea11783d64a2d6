"""The functions of a law of forces on spheres. Its parameters have two fields besides.

quantum: the force that counts as one; ahead: the distance beyond the reach at which a pair counts
as near.
"""

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.scalar.jit import generic


@kernel
def measure_all(worker, time, law, world, readings):
    """Readings (n, 8) of every sphere, by the law of contacts."""
    first, last = share(len(world.bodies.number), worker.thread, worker.threads)
    for i in range(first, last):
        measure(law, i, time, world, readings[i])


@generic
def act(law, mine, time, step, world, noted, room):
    """Find forces and torques on the spheres of a thread, from `mine[0]` to before `mine[1]`, by
    neighbours and walls; contacts grow by a step. `room` is for the loops here alone."""


@generic
def turns(law):
    """Whether the law makes spheres turn, as a literal."""


@generic
def beside(solid, law, i, time, step, world, room):
    """Add force and torque of a solid on a sphere; returns a bound of them."""


@generic
def measure_beside(solid, law, i, time, world, readings):
    """Add the contacts with a solid to the readings of a sphere."""


@generic
def measure(law, i, time, world, readings):
    """Add up the readings of a sphere, in quanta, in a row of eight: twice its share of the
    potential energy, r F of its pairs (xx, yy, zz, xy, xz, yz), and the number of contacts."""
