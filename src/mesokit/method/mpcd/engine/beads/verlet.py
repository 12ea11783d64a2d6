"""Velocity Verlet, for the beads of solutes and the molecules of a fluid alike.

Half a kick, then a drift and a kick for each sub-step, the last kick a half one.
"""

from mesokit.case.box import at_time
from mesokit.geometry.protocol import free
from mesokit.method.mpcd.engine.cpu.bounce import bounce
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.streaming import fall
from mesokit.scalar.jit import generic, scalar
from mesokit.scalar.random import Counter
from mesokit.scalar.vector import scaled

SUBSTEP_BITS = 40  # sub-steps stand above these bits of a step's number in random streams


@where()
def verlet(moving, now, physics, substeps):
    """Positions and velocities a timestep later, in sub-steps."""
    # With h = dt / substeps: after kick n, r is at t + n h and v at t + (n + 1/2) h. The first and
    # the last kick are half ones, so v ends at t + dt. The two half kicks between drifts are one.
    for n in range(substeps + 1):
        if n > 0:  # r: t + (n - 1) h -> t + n h
            drift_in(moving, now, physics, substeps, n)
        # v: the second half of the kick of that sub-step, and the first half of the next one's
        kick_after(moving, now, physics, substeps, n)


@scalar
def drift_in(moving, now, physics, substeps, n):
    """The flight of the nth sub-step, from 1."""
    at = Counter(now.counter.seed, now.counter.step + (n << SUBSTEP_BITS))
    drift(moving, at, physics, physics.timestep / substeps)


@scalar
def kick_after(moving, now, physics, substeps, n):
    """The kick after the nth flight, or that before the first one."""
    time, box = physics.timestep / substeps, box_after(now, physics, substeps, n)
    kick(moving, now.counter.step, box, physics, time if 0 < n < substeps else 0.5 * time)


@scalar
def box_after(now, physics, substeps, n):
    """The box after n of the sub-steps."""
    time = physics.timestep / substeps
    return at_time(now.box, (now.counter.step - 1) * physics.timestep + n * time)


@generic
def drift(moving, counter, physics, time):
    """Straight flight for a time, with reflections."""


@generic
def kick(moving, step, box, physics, time):
    """Change of the velocities by the forces of where the beads are, kept for a time.

    `box` is that of now, `step` the number by which broken bonds are noted.
    """


@scalar
def flown(physics, time, counter, number, m, r, v, impulse):
    """Position and velocity a time later of a bead that may hit a surface."""
    rest = scaled(0.0, physics.zero)
    if free(physics.solid, r, v, rest, time):
        return fall(r, v, rest, time)
    return bounce(physics, time, counter, (number, m), r, v, rest, impulse)
