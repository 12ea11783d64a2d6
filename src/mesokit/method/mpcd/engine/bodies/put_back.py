"""Particles that were near bodies, back in their strips and in the sums of their cells."""

from mesokit.method.mpcd.engine.bodies.state import COUNT, LANE, START, R, V, load
from mesokit.method.mpcd.engine.cpu.strips.one import put_one
from mesokit.scalar.jit import scalar


@scalar
def put_all_back(worker, now, physics, fluid, bodies):
    """All particles of this thread's list, at t + dt."""
    thread, values, zero = worker.thread, bodies.values[worker.thread], physics.zero
    for j in range(bodies.counters[thread, COUNT]):
        r, v = load(values, j, R, zero), load(values, j, V, zero)
        start = load(values, j, START, zero)
        put_one(worker, now, physics, fluid, bodies.numbers[thread, j, LANE], start, r, v)
