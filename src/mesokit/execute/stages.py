"""The stages of a step, each a loop over the lanes of one strip of particles."""

from typing import Any, NamedTuple

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.box import slide
from mesokit.execute.bounce import bounce
from mesokit.execute.cell_energy import tally
from mesokit.execute.layout import LANES, QUAD, SCRATCH_ROW, sums_length
from mesokit.execute.look_around import FEW, lanes_together
from mesokit.execute.records import gather, scatter_add
from mesokit.execute.rows import add_to, count_images, load, mass_of, note, recall, store
from mesokit.execute.sums import terms_of
from mesokit.geometry.bodies import Bodies
from mesokit.geometry.none import Nothing
from mesokit.geometry.protocol import exposed, free, leaps, touches
from mesokit.mpcd.collision.protocol import collide, contribute
from mesokit.mpcd.streaming import fall, halfway, vector
from mesokit.scalar import added_scaled, by_type, chosen, mul_add, optional, scalar


class Physics(NamedTuple):
    """What the particles obey: parameters of each part, whose types pick the compiled physics."""

    rule: tuple
    thermostat: tuple
    field: tuple
    solid: tuple
    masses: tuple  # (mass,) or () for a row of masses in each strip
    energy: tuple  # how cells learn their kinetic energy
    timestep: float
    kT: float
    molecule: tuple  # what holds the beads of molecules together, or () for single particles


def kind_of_solid(physics: Any) -> type:
    """The class of the solid, from the numba type of `Physics`."""
    solid = physics.types[physics.fields.index("solid")]
    return solid.instance_class


class Grid(NamedTuple):
    """The collision cells of one step."""

    shift: tuple  # added to positions, in cells
    origin: tuple  # the same, plus 1 along an axis where a wall's cell comes first
    cells: tuple  # number along each axis
    inverse: tuple


@scalar
def in_cell(r, grid):
    """Position relative to the centre of its cell."""
    for k in range(len(r)):
        x = r[k] + grid.origin[k]
        r = tuple_setitem(r, k, x - np.floor(x) - 0.5)
    return r


@scalar
def cell_index(r, grid):
    """Number of the cell at r; x varies fastest. A place that is no number gets the spare cell."""
    index, cells = 0.0, 1.0
    for j in range(len(r)):
        k = len(r) - 1 - j
        i = np.floor(r[k] + grid.origin[k])
        # half a cell keeps the quotient away from whole numbers, where it might round either way
        images = np.floor(mul_add(i, grid.inverse[k], 0.5 * grid.inverse[k]))
        index = mul_add(index, grid.cells[k], mul_add(-grid.cells[k], images, i))
        cells *= grid.cells[k]
    return np.int32(index if (index >= 0.0) & (index < cells) else cells)


@scalar
def gather_strip(cell, coefficients, gathered, c):
    """Bring the coefficients of each particle's cell into rows."""
    for i in range(0, LANES, QUAD):
        gather(coefficients, cell, i, gathered, c)


@scalar
def collided(physics, grid, gathered, i, r, v, c):
    """Velocity of lane i after the collision in its cell."""
    return collide(physics.rule, recall(gathered, i, c), v, in_cell(r, grid))


@by_type
def clear_of(solid, clear, i):
    """Square of the distance that lane i may fly in any direction: (d,) if it is in tables."""
    if solid.instance_class is Bodies:
        return lambda solid, clear, i: (np.int32(clear[i]).view(np.float32),)
    return lambda solid, clear, i: ()


@scalar
def fly(physics, strip, i, r, v, around, hits):
    """Store position and velocity a timestep later; a particle that may hit a surface stays behind.

    The latter is marked in `hits`, and 1 is the answer. `around` is what `touches` asks for.
    """
    a = halfway(physics.field, r, v, physics.timestep)
    there = fall(r, v, a, physics.timestep)
    hit = np.int64(touches(physics.solid, around, r, v, vector(a, r), physics.timestep))
    if exposed(physics.solid):
        hits[i] = hit
    store(strip, i, 0, chosen(hit != 0, r + v, there[0] + there[1]))
    return hit


@scalar
def collide_strip(physics, grid, strip, gathered, like, c):
    """Velocities after the collision."""
    d = len(like)
    for i in range(LANES):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        store(strip, i, d, collided(physics, grid, gathered, i, r, v, c))


@scalar
def stream_strip(physics, strip, clear, hits, like):
    """Positions and velocities a timestep later.

    The answer has a bit for each part of the strip in which particles may have stayed behind.
    """
    d = len(like)
    any_hit = np.int64(0)
    for i in range(LANES):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        any_hit |= fly(physics, strip, i, r, v, clear_of(physics.solid, clear, i), hits)
    return -any_hit  # all bits


@by_type
def collide_and_stream_strip(physics, grid, strip, gathered, quiet, clear, hits, like, c):
    """The two above in one loop; `quiet` is what `look_around_strip` said."""

    def among_solids(physics, grid, strip, gathered, quiet, clear, hits, like, c):
        d, any_hit = len(like), np.int64(0)
        for i in range(LANES):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            v = collided(physics, grid, gathered, i, r, v, c)
            any_hit |= fly(physics, strip, i, r, v, (), hits)
        return any_hit

    def looked_around(physics, grid, strip, gathered, quiet, clear, hits, like, c):
        behind = np.int64(0)
        for part in range(LANES // FEW):
            start = part * FEW
            any_hit = move_few(
                physics, grid, strip[start:], gathered[start:], (quiet >> part) & 1,
                clear[start:], hits[start:], like, c,
            )  # fmt: skip
            behind |= any_hit << part
        return behind

    return looked_around if kind_of_solid(physics) is Bodies else among_solids


@by_type
def move_few(physics, grid, strip, gathered, quiet, clear, hits, like, c):
    """A part of a strip; where it is quiet, with a simpler question."""
    return _move_few


def _move_few(physics, grid, strip, gathered, quiet, clear, hits, like, c):
    d, any_hit = len(like), np.int64(0)
    if quiet != 0:
        for i in range(FEW):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            v = collided(physics, grid, gathered, i, r, v, c)
            any_hit |= fly(physics, strip, i, r, v, (), hits)
    else:
        for i in range(FEW):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            v = collided(physics, grid, gathered, i, r, v, c)
            any_hit |= fly(physics, strip, i, r, v, clear_of(physics.solid, clear, i), hits)
    return any_hit


@by_type
def bounce_strip(physics, counter, strip, count, behind, ident, hits, impulse, scales, like):
    """Flight of the marked particles, with reflections; what surfaces take goes to impulse.

    `behind` and the answer have a bit for each part of the strip: whether some stayed behind, and
    whether any of these then went farther than a stride.
    """
    return _bounce_strip if kind_of_solid(physics) is not Nothing else lambda *_: 0


def _bounce_strip(physics, counter, strip, count, behind, ident, hits, impulse, scales, like):
    d, far, width = len(like), 0, lanes_together(physics.solid)
    for start in range(0, count, width):
        part, marked = start // width, start
        if (behind >> part) & 1 == 0:
            continue
        for i in range(start, min(start + width, count)):  # their numbers first, without branches
            hit = hits[i]
            hits[marked] = i
            marked += hit
        for j in range(start, marked):
            i = hits[j]
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            a = vector(halfway(physics.field, r, v, physics.timestep), like)
            if free(physics.solid, r, v, a, physics.timestep):
                end, v = fall(r, v, a, physics.timestep)
            else:
                m = mass_of(physics.masses, strip, i, 2 * d)
                end, v = bounce(physics, counter, ident[i], m, r, v, a, impulse, scales[0])
            store(strip, i, 0, end + v)
            if leaps(physics.solid, added_scaled(end, -1.0, r)):
                far |= 1 << part
    return far


@scalar
def slide_strip(box, grid, strip, image, like):
    """Bring particles that left a sheared box back into it; nothing in other boxes."""
    d = len(like)
    for i in range(LANES):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        r, v, crossed = slide(box, r, v, grid.shift)
        store(strip, i, 0, r + v)
        count_images(image, i, crossed)


@scalar
def bin_strip(physics, counter, grid, strip, cell, ident, terms_rows, scales, like):
    """Cell of each particle, and what it adds to the sums of that cell.

    Rules that draw velocities anew put them in the place of the old ones.
    """
    d = len(like)
    for i in range(LANES):
        r, v = load(strip, i, 0, like), load(strip, i, d, like)
        m = mass_of(physics.masses, strip, i, 2 * d)
        kept, own = contribute(physics.rule, counter, (ident[i], 0), m, v, in_cell(r, grid))
        cell[i] = cell_index(r, grid)
        store(strip, i, 0, r + kept)
        counted = tally(physics.energy, m, v)
        note(terms_rows, i, terms_of(physics, m, v, own, scales) + counted)


@scalar
def add_strip(cell, terms_rows, sums, count, terms, tallied):
    """Add the terms of each particle to the sums of its cell, and count it (see `scatter_add`)."""
    width = sums_length(len(terms))
    together = count - count % QUAD
    for i in range(0, together, QUAD):
        scatter_add(sums, cell, i, terms_rows, terms, tallied)
    for i in range(together, count):
        start = np.uint64(np.uint32(cell[i])) * np.uint64(width)
        row = terms_rows[len(terms) * SCRATCH_ROW :]
        sums[start] += optional(recall(row, i, tallied), 1)
        add_to(sums, start + np.uint64(1), recall(terms_rows, i, terms))
