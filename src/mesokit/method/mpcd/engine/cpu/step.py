"""The step: its stages in order, run by all threads together, and the loop over steps."""

from mesokit.case.box import at_time
from mesokit.kernels.kernel import inner, kernel
from mesokit.loops.clock import BEADS, CELLS, FINISH, START, SWEEP, lap
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.beads.coupling import answer_beads, join_beads
from mesokit.method.mpcd.engine.beads.flight import move_solutes
from mesokit.method.mpcd.engine.bodies.stages import (
    fill_bodies,
    recoil_bodies,
    stream_with_bodies,
)
from mesokit.method.mpcd.engine.cell_gradient import fill_neighbour_sums
from mesokit.method.mpcd.engine.cpu.collide import collide_cells
from mesokit.method.mpcd.engine.cpu.grid import moved_grid
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM, Now
from mesokit.method.mpcd.engine.cpu.physics import field_of, field_of_step, with_field
from mesokit.method.mpcd.engine.cpu.sweep import stream_fluid
from mesokit.method.mpcd.engine.domains.messages.exchange import (
    exchange_sums,
    receive_coefficients,
    send_coefficients,
)
from mesokit.method.mpcd.engine.domains.messages.migrate import (
    count_molecules,
    migrate,
    note_done,
    room_left,
)
from mesokit.method.mpcd.engine.embedded.flight import move_in_fluid
from mesokit.method.mpcd.engine.embedded.state import is_embedded
from mesokit.method.mpcd.engine.embedded.sweep import put_back, stream_around
from mesokit.method.mpcd.engine.virtual.gradient import follow_flow
from mesokit.method.mpcd.engine.virtual.one_by_one import (
    fill_one_by_one,
    recoil_one_by_one,
    top_up_walls,
)
from mesokit.method.mpcd.engine.virtual.particles import drawn_per_cell
from mesokit.method.mpcd.engine.virtual.per_cell import fill_cells, recoil_per_cell
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.random import Counter, grid_shift


@by_type
def stream(worker, now, physics, fluid, suspended):
    """The fluid's part (see `cpu.sweep.stream_fluid`); with bodies that move, and around solutes
    that act by a potential."""
    if len(field_of(suspended, "bodies")) > 0:
        return lambda worker, now, physics, fluid, suspended: stream_with_bodies(
            worker, now, physics, fluid, suspended
        )
    if is_embedded(field_of(suspended, "beads")):
        return lambda worker, now, physics, fluid, suspended: stream_around(
            worker, now, physics, fluid, suspended.beads
        )
    return lambda worker, now, physics, fluid, suspended: stream_fluid(worker, now, physics, fluid)


@by_type
def move_beads(worker, now, physics, fluid, suspended):
    """The solutes' part (see `beads.flight.move_solutes`), with the fluid near them.

    Beside bodies they have moved already, with these (`beads.among_bodies`).
    """
    if len(field_of(suspended, "bodies")) > 0:
        return lambda worker, now, physics, fluid, suspended: None
    if not is_embedded(field_of(suspended, "beads")):
        return lambda worker, now, physics, fluid, suspended: move_solutes(
            worker, now, physics, fluid, suspended.beads
        )

    def together(worker, now, physics, fluid, suspended):
        move_in_fluid(worker, now, physics, fluid, suspended.beads)
        put_back(worker, now, physics, fluid, suspended.beads)

    return together


@by_type
def fill_walls(worker, now, physics, fluid, walls):
    """Virtual particles at t + dt in the cells that walls cut, and their part in the sums of these.

    They are drawn all of a cell at once where the collision rule does not give it, else one by one.
    """
    if len(field_of(walls, "virtual")) == 0 or len(field_of(walls, "top_up")) > 0:
        return lambda *_: None
    return fill_cells if drawn_per_cell(walls) else fill_one_by_one


@inner
def fill_solids(worker, now, physics, fluid, suspended, walls):
    """Virtual particles of walls, and those of bodies."""
    fill_walls(worker, now, physics, fluid, walls)
    fill_bodies(worker, now, physics, fluid, suspended.bodies)


@inner
def recoil(worker, now, physics, fluid, suspended, walls):
    """The impulses that walls and bodies take by the collision of the virtual particles in them."""
    recoil_walls(worker, now, physics, fluid, walls)
    recoil_bodies(worker, now, physics, fluid, suspended.bodies)


@by_type
def recoil_walls(worker, now, physics, fluid, walls):
    """Add the impulse that walls take by the collision of the virtual particles in them."""
    if len(field_of(walls, "virtual")) == 0:
        return lambda *_: None
    return recoil_per_cell if drawn_per_cell(walls) else recoil_one_by_one


@inner
def step(worker, now, physics, fluid, suspended, walls):
    """One collision interval: r, v from t to t + dt. `suspended` has beads and bodies."""
    beads = suspended.beads
    stream(worker, now, physics, fluid, suspended)  # v: collision at t; r, v: t -> t + dt; sums
    lap(worker, SWEEP)
    move_beads(worker, now, physics, fluid, suspended)  # the same for solutes, in sub-steps
    lap(worker, BEADS)
    fill_solids(worker, now, physics, fluid, suspended, walls)  # virtual particles at t + dt
    barrier(worker)
    lap(worker, SWEEP)
    exchange_sums(worker, now, physics, fluid, beads)  # ranks: sums to the owners of cells
    follow_flow(worker, now, physics, fluid, walls)  # flow near surfaces, for the next step
    top_up_walls(worker, now, physics, fluid, walls)  # up to the mean number of a cell
    fill_neighbour_sums(worker, physics, fluid)  # sums for gradients over neighbouring cells
    join_beads(worker, now, physics, fluid, beads)  # cells with solutes: sums of both
    send_coefficients(worker, now, physics, fluid, beads, walls)  # ranks: to partners
    collide_cells(worker, now, physics, fluid)  # thermostat, rule at t + dt: coefficients
    answer_beads(worker, now, physics, fluid, beads)
    receive_coefficients(worker, now, physics, fluid, walls)  # ranks: from owners of cells
    barrier(worker)
    lap(worker, CELLS)
    recoil(worker, now, physics, fluid, suspended, walls)  # what it takes from virtual particles


@kernel
def advance(worker, course, physics, fluid, suspended, walls):
    """Run some steps; velocities are those after the collision of the last when it returns."""
    lap(worker, START)
    now = Now(Counter(course.seed, course.done), course.box, course.grid, course.grid, 0)
    n = 0
    while n < course.steps and room_left(fluid):
        number, now = interval(worker, course, now, physics, fluid, suspended, walls, n)
        n += number
        count_molecules(fluid)  # ranks: after a migration
    note_done(worker, fluid, n)
    if n > 0:
        now = last_collision(course, now)
        stream(worker, now, physics, fluid, suspended)
        move_beads(worker, now, physics, fluid, suspended)
        barrier(worker)
        lap(worker, FINISH)


@inner
def interval(worker, course, now, physics, fluid, suspended, walls, n):
    """Steps from the nth on, all or up to the next one after which particles change ranks."""
    first, going = n, True
    while n < course.steps and going:
        now = next_step(course, now, physics, n)
        field = field_of_step(physics, course.done + n)
        step(worker, now, with_field(physics, field), fluid, suspended, walls)
        going = migrate(worker, now, physics, fluid)
        n += 1
    return n - first, now


@scalar
def next_step(course, now, physics, n):
    """The nth step. The collision of step n is done while streaming to n + 1: see `stream`."""
    counter = Counter(course.seed, course.done + n + 1)
    box = at_time(now.box, (course.done + n + 1) * physics.timestep)
    grid = moved_grid(now.grid, grid_shift(counter, physics.zero, course.grid_shift), course.closed)
    flags = course.flags & ~MEASURE_STRESS | STREAM | (COLLIDE if n > 0 else 0)
    flags |= course.flags & MEASURE_STRESS if n == course.steps - 1 else 0
    return Now(counter, box, now.grid, grid, flags)


@scalar
def last_collision(course, now):
    """The flags of the collision that is left after the last step."""
    return Now(now.counter, now.box, now.grid, now.grid, course.flags | COLLIDE)
