"""What readers ask of all spheres."""

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.method.spheres.soft.engine.acting import tell


@kernel
def tell_all(team, time, law, world, told):
    """What the law tells of every sphere, (n, 8)."""
    first, last = share(len(world.bodies.number), team.thread, team.threads)
    for i in range(first, last):
        tell(law, i, time, world, told[i])
