"""The stages of a step, each a loop over the lanes of one strip of particles."""

import numpy as np

from mesokit.case.box import slide
from mesokit.geometry.protocol import exposed, leaps, touches
from mesokit.geometry.solids.bodies import Bodies
from mesokit.loops.layout import LANES, OF_LINE, QUAD, SCRATCH_ROW, sums_length
from mesokit.method.mpcd.collision.protocol import collide
from mesokit.method.mpcd.engine.cpu.bounce import fly_among
from mesokit.method.mpcd.engine.cpu.grid import cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.near_solids import FEW, lanes_together
from mesokit.method.mpcd.engine.cpu.physics import has_solid, kind_of_solid
from mesokit.method.mpcd.engine.cpu.strips.ahead import fetch_places, fetch_velocities
from mesokit.method.mpcd.engine.cpu.strips.records import gather, scatter_add
from mesokit.method.mpcd.engine.cpu.strips.rows import (
    add_values,
    count_images,
    lane_mass,
    load_particle,
    load_scratch,
    store_particle,
    store_scratch,
)
from mesokit.method.mpcd.engine.cpu.strips.terms import brought
from mesokit.method.mpcd.engine.where import where
from mesokit.method.mpcd.streaming import fall, halfway, vector
from mesokit.scalar.jit import by_type, optional, scalar
from mesokit.scalar.vector import added_scaled, chosen


@scalar
def gather_strip(cell, coefficients, gathered, pattern, following):
    """Bring the coefficients of each particle's cell into rows; prefetch the next places."""
    for i in range(0, LANES, OF_LINE):
        for k in range(0, OF_LINE, QUAD):
            gather(coefficients, cell, i + k, gathered, pattern)
        fetch_places(following, i)


@scalar
def collided(physics, grid, gathered, i, r, v):
    """Velocity of lane i after the collision in its cell."""
    needed = load_scratch(gathered, i, physics.coefficients)
    return collide(physics.rule, needed, v, in_cell(r, grid))


@by_type
def clear_of(solid, clear, i):
    """Square of the distance that lane i may fly in any direction: (d,) if it is in tables."""
    if solid.instance_class is Bodies:
        return lambda solid, clear, i: (np.int32(clear[i]).view(np.float32),)
    return lambda solid, clear, i: ()


@scalar
def fly(physics, strip, i, r, v, around, hits):
    """Store position and velocity a timestep later; one that may hit a surface stays where it is.

    The latter is marked in `hits`, and the result is 1. `around` is an argument of `touches`.
    """
    a = halfway(physics.field, r, v, physics.timestep)
    end, after = fall(r, v, a, physics.timestep)
    hit = np.int64(touches(physics.solid, around, r, v, vector(a, r), physics.timestep))
    if exposed(physics.solid):
        hits[i] = hit
    store_particle(strip, i, 0, chosen(hit != 0, r + v, end + after))
    return hit


@scalar
def collide_strip(physics, grid, strip, gathered):
    """Velocities after the collision."""
    zero = physics.zero
    d = len(zero)
    for i in range(LANES):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        store_particle(strip, i, d, collided(physics, grid, gathered, i, r, v))


@scalar
def stream_strip(physics, strip, clear, hits):
    """Positions and velocities a timestep later.

    The result has a bit for each part of the strip in which particles may have stayed behind.
    """
    zero = physics.zero
    d = len(zero)
    any_hit = np.int64(0)
    for i in range(LANES):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        any_hit |= fly(physics, strip, i, r, v, clear_of(physics.solid, clear, i), hits)
    return -any_hit  # all bits


@by_type
def collide_and_stream_strip(physics, grid, strip, gathered, quiet, clear, hits):
    """The two above in one loop; `quiet` is the result of `look_around_strip`."""

    def among_solids(physics, grid, strip, gathered, quiet, clear, hits):
        zero, any_hit = physics.zero, np.int64(0)
        d = len(zero)
        for i in range(LANES):
            r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            v = collided(physics, grid, gathered, i, r, v)
            any_hit |= fly(physics, strip, i, r, v, (), hits)
        return any_hit

    def looked_around(physics, grid, strip, gathered, quiet, clear, hits):
        left = np.int64(0)
        # Parts of 64 lanes, each with one bit in `left`. In a quiet part every flight up to a
        # stride is free, so the loop needs no distance for each lane.
        for part in range(LANES // FEW):
            start = part * FEW
            any_hit = move_few(
                physics,
                grid,
                strip[start:],
                gathered[start:],
                (quiet >> part) & 1,
                clear[start:],
                hits[start:],
            )
            left |= any_hit << part
        return left

    return looked_around if kind_of_solid(physics) is Bodies else among_solids


@where()
def move_few(physics, grid, strip, gathered, quiet, clear, hits):
    """Collide and stream a part of a strip; a quiet part needs a simpler test."""
    zero, any_hit = physics.zero, np.int64(0)
    d = len(zero)
    if quiet != 0:
        for i in range(FEW):
            r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            v = collided(physics, grid, gathered, i, r, v)
            any_hit |= fly(physics, strip, i, r, v, (), hits)
    else:
        for i in range(FEW):
            r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            v = collided(physics, grid, gathered, i, r, v)
            any_hit |= fly(physics, strip, i, r, v, clear_of(physics.solid, clear, i), hits)
    return any_hit


@where("0", physics=has_solid)
def bounce_strip(physics, counter, strip, count, left, ident, hits, impulse):
    """Flight of the marked particles, with reflections; what surfaces take goes to impulse.

    `left` and the result have a bit for each part of the strip: whether some are left, and
    whether any of these then went farther than a stride.
    """
    zero, far, width = physics.zero, 0, lanes_together(physics.solid)
    d = len(zero)
    # Only particles that stayed behind in `fly` are moved here, with reflections. They are few, so
    # this loop is scalar. Random numbers of diffuse surfaces follow from ids: order does not
    # matter.
    for start in range(0, count, width):
        part, marked = start // width, start
        if (left >> part) & 1 == 0:
            continue
        # Compact their lanes to the front of the part, without branches. No unread mark is lost,
        # since `marked` never exceeds i.
        for i in range(start, min(start + width, count)):
            hit = hits[i]
            hits[marked] = i
            marked += hit
        for j in range(start, marked):
            i = hits[j]
            r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            particle = ident[i], lane_mass(physics.masses, strip, i, 2 * d)
            end, v = fly_among(physics, counter, particle, r, v, impulse)
            store_particle(strip, i, 0, end + v)
            if leaps(physics.solid, added_scaled(end, -1.0, r)):
                far |= 1 << part
    return far


@scalar
def slide_strip(box, grid, strip, image, zero):
    """Bring particles that left a sheared box back into it; nothing in other boxes."""
    d = len(zero)
    for i in range(LANES):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        r, v, crossed = slide(box, r, v, grid.shift)
        store_particle(strip, i, 0, r + v)
        count_images(image, i, crossed)


@scalar
def bin_strip(physics, now, strip, cell, ident, terms_rows):
    """Cell of each particle, and what it adds to the sums of that cell.

    Rules that draw velocities anew put them in the place of the old ones.
    """
    zero = physics.zero
    d = len(zero)
    # Lane by lane what each brings (see `brought`), in rows from which sums of cells are made.
    for i in range(LANES):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        m = lane_mass(physics.masses, strip, i, 2 * d)
        kept, terms, counted = brought(physics, now, ident[i], m, r, v)
        cell[i] = cell_index(r, now.grid)
        store_particle(strip, i, 0, r + kept)
        store_scratch(terms_rows, i, terms + counted)


@scalar
def add_strip(cell, terms_rows, sums, count, terms, tallied, following):
    """Add the terms of each particle to the sums of its cell, and count it (see `scatter_add`).

    Velocities of the next strip are prefetched meanwhile.
    """
    width = sums_length(len(terms))
    together = count - count % OF_LINE
    # Four lanes at a time as whole vectors, then the rest one by one. Spare lanes are left out:
    # this is where nonsense in them ends.
    for i in range(0, together, OF_LINE):
        for k in range(0, OF_LINE, QUAD):
            scatter_add(sums, cell, i + k, terms_rows, terms, tallied)
        fetch_velocities(following, i)
    for i in range(together, count):
        start = np.uint64(np.uint32(cell[i])) * np.uint64(width)
        row = terms_rows[len(terms) * SCRATCH_ROW :]
        sums[start] += optional(load_scratch(row, i, tallied), 1)
        add_values(sums, start + np.uint64(1), load_scratch(terms_rows, i, terms))
