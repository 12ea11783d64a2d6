"""The stages of a step that bodies add, in their order: the algorithm at a glance."""

from mesokit.kernels.kernel import inner
from mesokit.method.mpcd.engine.beads.among_bodies import move_together
from mesokit.method.mpcd.engine.bodies.dipoles import kick_fluid
from mesokit.method.mpcd.engine.bodies.gas import draw_all_gas, take_recoil
from mesokit.method.mpcd.engine.bodies.hits import reflect_all
from mesokit.method.mpcd.engine.bodies.motion import begin_step
from mesokit.method.mpcd.engine.bodies.near import kicks_fluid
from mesokit.method.mpcd.engine.bodies.sweep import put_all_back, stream_around_bodies
from mesokit.method.mpcd.engine.cpu.physics import field_of, of_bodies, of_cells, of_particles
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import by_type


@inner
def stream_with_bodies(worker, now, physics, fluid, suspended):
    """The collision at t, and the flight t -> t + dt of bodies and fluid."""
    bodies = suspended.bodies
    begin(worker, now, physics, fluid, suspended)  # forces; one rigid motion each
    stream_around_bodies(worker, now, physics, fluid, bodies)  # particles that no body can reach
    kick_nearby(worker, now, physics, fluid, bodies)  # counter-forces on the fluid near bodies
    reflect_all(worker, now, of_bodies(physics), fluid, bodies)  # all others: one reflection a body
    put_all_back(worker, now, of_particles(physics), fluid, bodies)  # their cells and sums


@by_type
def begin(worker, now, physics, fluid, suspended):
    """What moves bodies without the fluid; beads of solutes move in the same sub-steps."""
    if len(field_of(suspended, "beads")) > 0:
        return lambda worker, now, physics, fluid, suspended: move_together(
            worker, now, physics, fluid, suspended.beads, suspended.bodies
        )
    return lambda worker, now, physics, fluid, suspended: begin_step(
        worker, now, of_bodies(physics), fluid, suspended.bodies
    )


@where(bodies=kicks_fluid)
def kick_nearby(worker, now, physics, fluid, bodies):
    """Forces and torques on bodies that the fluid nearby takes back."""
    kick_fluid(worker, now, of_bodies(physics), fluid, bodies)


@where(bodies=len)
def fill_bodies(worker, now, physics, fluid, bodies):
    """Virtual particles at t + dt in the cells that bodies cut."""
    draw_all_gas(worker, now, of_cells(physics), fluid, bodies)


@where(bodies=len)
def recoil_bodies(worker, now, physics, fluid, bodies):
    """Give bodies what the collision gives their virtual particles."""
    take_recoil(worker, now, of_cells(physics), fluid, bodies)
