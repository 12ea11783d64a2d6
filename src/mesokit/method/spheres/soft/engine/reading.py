"""Readings of all spheres."""

from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import share
from mesokit.method.spheres.soft.engine.acting import measure


@kernel
def measure_all(worker, time, law, world, readings):
    """Readings (n, 8) of every sphere, by the law of contacts."""
    first, last = share(len(world.bodies.number), worker.thread, worker.threads)
    for i in range(first, last):
        measure(law, i, time, world, readings[i])
