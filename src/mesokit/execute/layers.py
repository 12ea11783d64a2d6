"""Virtual particles of a slit: a gas in the two layers of cells that the plates cut."""

import math

from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.execute.bounce import take
from mesokit.execute.cell_energy import tally
from mesokit.execute.flags import COLLIDE, MEASURE_WALLS, STREAM
from mesokit.execute.layout import LANES, share, strip_at
from mesokit.execute.rows import load, mass_of, store
from mesokit.execute.stages import (
    add_strip,
    bin_strip,
    collide_strip,
    gather_strip,
    kind_of_solid,
)
from mesokit.geometry.plates import SlitX, SlitY, SlitZ
from mesokit.geometry.protocol import closes, lever, side
from mesokit.random import VIRTUAL_POSITION, VIRTUAL_VELOCITY, normals, unit_open, words
from mesokit.scalar import added, by_type, first, scalar, scaled


@by_type
def fill_layers(
    thread, threads, what, physics, counter, old, grid, particles, cells, rates, gathered, quanta,
    impulse, like, c, terms, scales,
):  # fmt: skip
    """Strips of virtual particles of a slit: what the flags ask; nothing for other solids."""
    return _fill if kind_of_solid(physics) in (SlitX, SlitY, SlitZ) else lambda *_: None


def _fill(
    thread, threads, what, physics, counter, old, grid, particles, cells, rates, gathered, quanta,
    impulse, like, c, terms, scales,
):  # fmt: skip
    data, cell, ident, _, count, strips, first_virtual, rows, spare_cell = particles
    coefficients, sums = cells
    start, end = share(strips[1], thread, threads)
    for s in range(start, end):
        b = first_virtual + s
        strip, here = data[strip_at(b, rows)], cell[b * LANES : (b + 1) * LANES]
        who = ident[b * LANES : (b + 1) * LANES]
        lanes = min(LANES, count[1] - s * LANES)
        if what & COLLIDE and what & MEASURE_WALLS:
            gather_strip(here, coefficients, gathered, c)
            collide_strip(physics, old, strip, gathered, like, c)
            wall_momentum(physics, strip, lanes, impulse, scales[0], 1.0, like)
        if what & STREAM:
            fill_strip(physics, counter, grid, strip, s * LANES, rates, like)
            if what & MEASURE_WALLS:
                wall_momentum(physics, strip, lanes, impulse, scales[0], -1.0, like)
            bin_strip(physics, counter, grid, strip, here, who, quanta, scales, like)
            for i in range(lanes):
                if side(physics.solid, load(strip, i, 0, like)) == 2:
                    here[i] = spare_cell
            add_strip(here, quanta, sums[thread], lanes, terms, tally(physics.energy, 0.0, like))


@scalar
def wall_momentum(physics, strip, count, impulse, scale, sign, like):
    """Add the momentum of virtual particles, as part of the wall behind which they lie."""
    d = len(like)
    for i in range(count):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        surface = side(physics.solid, r)
        if surface < 2:
            m = mass_of(physics.masses, strip, i, 2 * d)
            take(impulse, surface, lever(physics.solid, surface, r), scaled(sign * m, v), scale)


@scalar
def fill_strip(physics, counter, grid, strip, number, rates, like):
    """Virtual particles: a thermal gas of the fluid's density in the solid part of cut cells.

    Together the two layers of cut cells of a slit hold one layer of cells of solid, whatever the
    shift; each particle has a place in that layer, drawn anew at each step, and so belongs to the
    lower or the upper plate.
    """
    d = len(like)
    lower, upper = like, like
    for k in range(d):
        lower = tuple_setitem(lower, k, rates[0, k])
        upper = tuple_setitem(upper, k, rates[1, k])
    for i in range(LANES):
        a, b, c, _ = words(counter, VIRTUAL_POSITION, number + i, 0)
        place = first((unit_open(a), unit_open(b), unit_open(c)), like)
        r, u = closes(physics.solid, place, grid.shift, lower, upper)
        a, b, c, e = words(counter, VIRTUAL_VELOCITY, number + i, 0)
        m = mass_of(physics.masses, strip, i, 2 * d)
        v = added(u, scaled(math.sqrt(physics.kT / m), normals(like, a, b, c, e)))
        store(strip, i, 0, r + v)
