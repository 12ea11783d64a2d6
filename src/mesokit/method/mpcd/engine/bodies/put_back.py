"""Particles that were near bodies, back in their strips and in the sums of their cells."""

from mesokit.loops.layout import share, strip_at, strips_in
from mesokit.method.mpcd.engine.bodies.state import COUNT, LANE, START, R, V, load
from mesokit.method.mpcd.engine.cpu.strips.one import put_one
from mesokit.method.mpcd.engine.domains.messages.migrate import note_migrants
from mesokit.method.mpcd.engine.domains.messages.shared import shares
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import scalar


@scalar
def put_all_back(worker, now, physics, fluid, bodies):
    """All particles of this thread's list, at t + dt."""
    thread, values, zero = worker.thread, bodies.values[worker.thread], physics.zero
    for j in range(bodies.counters[thread, COUNT]):
        r, v = load(values, j, R, zero), load(values, j, V, zero)
        start = load(values, j, START, zero)
        put_one(worker, now, physics, fluid, bodies.numbers[thread, j, LANE], start, r, v)


@where(fluid=shares)
def note_all_migrants(worker, now, physics, fluid):
    """Note the particles that must change ranks in this step, when all have flown."""
    particles = fluid.particles
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    for s in range(first, last):
        strip = particles.data[strip_at(s, particles.rows)]
        note_migrants(worker, now, physics, fluid, strip, s)
