"""Steps of a flock: sort, look, turn and move."""

import numpy as np

from mesokit.kernels.kernel import inner, kernel
from mesokit.loops.threads import barrier
from mesokit.method.flock.engine.look import look
from mesokit.method.flock.engine.memory import STRIP
from mesokit.method.flock.engine.move import move
from mesokit.method.flock.engine.sort import cells_of, sort
from mesokit.method.flock.noise.protocol import FIRST_HEADING, unit_vector
from mesokit.scalar.random import METHOD, Counter, unit, words

START = METHOD + np.uint64(2)  # purpose of random numbers


@kernel
def step(worker, counter, steps, side, physics, flock):
    """So many steps; birds lie on `side` before and, if they are even in number, after them."""
    birds, seen, cells = flock.birds, flock.seen, flock.cells
    for done in range(steps):
        now = Counter(counter.seed, counter.step + np.uint64(done))
        sort(worker, physics.axes, birds, seen, cells, side)  # places, headings at t
        side = 1 - side
        look_and_move(worker, now, physics, flock, side)  # headings, then places: t -> t + dt
        barrier(worker)


@inner
def look_and_move(worker, now, physics, flock, side):
    """Add up the sums of the birds of this thread, turn and move them: a strip at a time."""
    birds, seen, cells, scratch = flock.birds, flock.seen, flock.cells, flock.scratch
    near, runs = scratch.near[worker.thread], scratch.runs[worker.thread]
    strip, pattern = scratch.strip[worker.thread], physics.axes.size
    begin, end = cells_of(worker, cells)
    done = cells.starts[begin]
    # Sums at t for the birds of a cell. When a strip of birds has its sums, it turns and moves, t
    # -> t + dt. Other threads may still look at these birds: they read the copies in `seen`, which
    # remain those at t. Cells have about equal work for each thread.
    for cell in range(begin, end):
        looked = cells.starts[cell + 1]
        if looked > cells.starts[cell]:
            look(physics, seen, cells.starts, near, runs, cell, pattern)
        while looked - done >= STRIP or (cell == end - 1 and looked > done):
            count = min(looked - done, STRIP)
            move(physics, now, birds, seen.sums, strip, side, done, count)
            done += count


@kernel
def scatter_places(counter, draw, size, numbers, places):
    """Places uniform in the box for birds with these numbers: the draw-th try."""
    for i in range(len(numbers)):
        for k in range(len(size)):
            high, low, _, _ = words(counter, START, numbers[i], 4 * draw + k)
            places[i, k] = size[k] * unit(high, low)


@kernel
def scatter_headings(counter, pattern, headings):
    """Headings uniform over all directions."""
    for i in range(len(headings)):
        a, b, c, d = words(counter, FIRST_HEADING, i, 0)
        u = unit_vector(pattern, unit(a, b), unit(c, d))
        for k in range(len(pattern)):
            headings[i, k] = u[k]
