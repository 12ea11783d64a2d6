"""The step: its stages in order, run by all threads together, and the loop over steps."""

from mesokit.case.box import at_time
from mesokit.kernels.kernel import inner, kernel
from mesokit.loops.clock import BEADS, CELLS, FINISH, START, SWEEP, lap
from mesokit.loops.threads import meet
from mesokit.method.mpcd.engine.beads.coupling import answer_beads, join_beads
from mesokit.method.mpcd.engine.cell_gradient import fill_field
from mesokit.method.mpcd.engine.cpu.collide import collide
from mesokit.method.mpcd.engine.cpu.grid import moved_grid
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM, Now
from mesokit.method.mpcd.engine.cpu.physics import field_of_step, with_field
from mesokit.method.mpcd.engine.domains.messages.exchange import (
    answer_others,
    give_sums,
    take_answers,
)
from mesokit.method.mpcd.engine.domains.messages.migrate import (
    hold_those_here,
    migrate,
    note_done,
    room_left,
)
from mesokit.method.mpcd.engine.embedded.stages import move_beads, stream
from mesokit.method.mpcd.engine.virtual.stages import fill_walls, follow_flow, recoil, top_up_walls
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import Counter, grid_shift


@inner
def step(team, now, physics, fluid, beads, walls):
    """One collision interval: r, v from t to t + dt."""
    stream(team, now, physics, fluid, beads)  # v: the collision at t; r, v: t -> t + dt; sums
    lap(team, SWEEP)
    move_beads(team, now, physics, fluid, beads)  # the same for solutes, in sub-steps
    lap(team, BEADS)
    fill_walls(team, now, physics, fluid, walls)  # virtual particles at t + dt
    meet(team)
    lap(team, SWEEP)
    give_sums(team, now, physics, fluid, beads)  # ranks: of cells of others
    follow_flow(team, now, physics, fluid, walls)  # what they will need to know of the fluid
    top_up_walls(team, now, physics, fluid, walls)  # those that depend on the fluid's number
    fill_field(team, physics, fluid)  # what cells must know of those next to them
    join_beads(team, now, physics, fluid, beads)  # cells with solutes: sums of both
    answer_others(team, now, physics, fluid, beads, walls)  # ranks: who have particles here
    collide(team, now, physics, fluid)  # thermostat and rule at t + dt: coefficients of each cell
    answer_beads(team, now, physics, fluid, beads)
    take_answers(team, now, physics, fluid, walls)
    meet(team)
    lap(team, CELLS)
    recoil(team, now, physics, fluid, walls)  # what the collision takes from virtual particles


@kernel
def advance(team, course, physics, fluid, beads, walls):
    """Run some steps; velocities are those after the collision of the last when it returns."""
    lap(team, START)
    now = Now(Counter(course.seed, course.done), course.box, course.grid, course.grid, 0)
    n = 0
    while n < course.steps and room_left(fluid):
        number, now = interval(team, course, now, physics, fluid, beads, walls, n)
        n += number
        hold_those_here(fluid)  # ranks: others may have come
    note_done(team, fluid, n)
    if n > 0:
        now = last_collision(course, now)
        stream(team, now, physics, fluid, beads)
        move_beads(team, now, physics, fluid, beads)
        meet(team)
        lap(team, FINISH)


@inner
def interval(team, course, now, physics, fluid, beads, walls, n):
    """Steps from the nth on, all or up to the next one after which particles change ranks."""
    first, going = n, True
    while n < course.steps and going:
        now = next_step(course, now, physics, n)
        field = field_of_step(physics, course.done + n)
        step(team, now, with_field(physics, field), fluid, beads, walls)
        going = migrate(team, now, physics, fluid)
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
    """What is left to do after the last step."""
    return Now(now.counter, now.box, now.grid, now.grid, course.flags | COLLIDE)
