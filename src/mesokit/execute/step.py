"""The step: its stages in order, run by all threads of a team together."""

from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.box import at_time
from mesokit.execute.cache import kernel
from mesokit.execute.cells import solve
from mesokit.execute.clock import lap
from mesokit.execute.flags import COLLIDE, MEASURE_STRESS, MEASURE_WALLS, STREAM
from mesokit.execute.guests import fill_guests, recoil, top_up_guests
from mesokit.execute.solute_cells import join_solutes, put_answers
from mesokit.execute.solutes import move_solutes
from mesokit.execute.stages import Grid
from mesokit.execute.sweep import sweep
from mesokit.execute.team import wait
from mesokit.execute.top_up import top_up
from mesokit.execute.wall_flow import follow
from mesokit.random import Counter, grid_shift
from mesokit.scalar import scalar

SWEEP, SOLVE, FINISH = 0, 1, 2  # stages whose time is kept


@scalar
def cells_at(shift, old, closed):
    """The cells for this shift; a wall's first cell lies below 0 where the shift is negative."""
    origin = shift
    for k in range(len(shift)):
        below = closed[k] > 0.5 and shift[k] < 0.0
        origin = tuple_setitem(origin, k, shift[k] + (1.0 if below else 0.0))
    return Grid(shift, origin, old.cells, old.inverse)


@kernel
def advance(
    thread, threads, gate, clock, steps, done, seed, strength, closed, what, density, wanted,
    guests, solutes, physics, box, grid, particles, cells, number, scratch, cell_scratch, like, c,
    terms, scales,
):  # fmt: skip
    """Run some steps; velocities are those after the collision of the last when it returns.

    The collision of step n is done in the sweep that streams to n + 1, while the particles are in
    the cache. With MEASURE_STRESS in `what` the last step is measured.
    """

    lap(clock, thread, -1)
    walls = what & MEASURE_WALLS
    rows, impulse = particles[7], scratch[5][thread]
    gathered, quanta = scratch[0][thread], scratch[4][thread]
    for n in range(steps):
        counter = Counter(seed, done + n + 1)
        box = at_time(box, (done + n + 1) * physics.timestep)
        new = cells_at(grid_shift(counter, like, strength), grid, closed)
        flags = walls | STREAM | (COLLIDE if n > 0 else 0)
        flags |= what & MEASURE_STRESS if n == steps - 1 else 0
        # v: collision at t; r, v: t -> t + dt; virtual particles; cells and their sums at t + dt
        sweep(
            thread, threads, flags, physics, box, counter, grid, new, particles, cells, scratch,
            like, c, terms, scales,
        )  # fmt: skip
        move_solutes(
            solutes, thread, threads, gate, flags, physics, box, counter, grid, new, cells[0],
            impulse, like, c, scales,
        )  # fmt: skip
        fill_guests(
            guests, density, thread, threads, what, physics, counter, new, rows, cells[1][thread],
            gathered, quanta, impulse, like, terms, scales,
        )  # fmt: skip
        wait(gate, threads)
        follow(
            wanted, guests, thread, threads, physics, counter, new, cells[1], scratch[7], like,
            terms, scales,
        )  # fmt: skip
        top_up(density, guests, thread, physics, counter, new, cells, number, like, scales)
        top_up_guests(
            guests, density, thread, threads, what, physics, counter, new, rows, cells[1], gathered,
            quanta, impulse, like, terms, scales,
        )  # fmt: skip
        if len(density) + len(wanted) > 0:
            wait(gate, threads)
        lap(clock, thread, SWEEP)
        join_solutes(
            solutes, thread, threads, physics, counter, cells[1], number, like, c, terms, scales
        )
        # thermostat and collision rule: what the particles of each cell need, at t + dt
        solve(
            thread, threads, physics, counter, cells, number, cell_scratch, like, c, terms, scales
        )
        put_answers(solutes, thread, threads, cells[0], number, c)
        wait(gate, threads)
        lap(clock, thread, SOLVE)
        recoil(
            guests, thread, what, physics, new, rows, cells[0], gathered, impulse, like, c, scales
        )
        grid = new
    if steps == 0:
        return
    counter = Counter(seed, done + steps)
    flags = COLLIDE | walls | (what & MEASURE_STRESS)
    sweep(
        thread, threads, flags, physics, box, counter, grid, grid, particles, cells, scratch,
        like, c, terms, scales,
    )  # fmt: skip
    move_solutes(
        solutes, thread, threads, gate, flags, physics, box, counter, grid, grid, cells[0], impulse,
        like, c, scales,
    )  # fmt: skip
    wait(gate, threads)
    lap(clock, thread, FINISH)
