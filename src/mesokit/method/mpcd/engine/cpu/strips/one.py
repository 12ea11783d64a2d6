"""One particle that waited for its flight, back in its strip and in the sums of its cell."""

import numpy as np

from mesokit.case.box import slide
from mesokit.geometry.protocol import leaps
from mesokit.loops.layout import LANES, strip_at, sums_length
from mesokit.method.mpcd.collision.protocol import contribute
from mesokit.method.mpcd.engine.cpu.grid import cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.near_solids import FEW, forget
from mesokit.method.mpcd.engine.cpu.physics import has_solid
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import tally
from mesokit.method.mpcd.engine.cpu.strips.rows import (
    add_values,
    count_images,
    lane_mass,
    store_particle,
)
from mesokit.method.mpcd.engine.cpu.strips.terms import terms_of
from mesokit.method.mpcd.engine.domains.messages.ghosts import note_ghost
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import optional, scalar, seldom
from mesokit.scalar.vector import added_scaled


@seldom
def put_one(worker, now, physics, fluid, lane, start, r, v):
    """Do the work of `slide_strip`, `bin_strip` and `add_strip` for the particle in a lane, which
    has flown from `start` to r."""
    particles, d = fluid.particles, len(r)
    s, i = lane // LANES, lane % LANES
    strip, sums = particles.data[strip_at(s, particles.rows)], fluid.cells.sums[worker.thread]
    forget_leap(physics, fluid.room, lane, added_scaled(r, -1.0, start))
    r, v, crossed = slide(now.box, r, v, now.grid.shift)
    count_images(particles.image, lane, crossed)
    m, key = lane_mass(physics.masses, strip, i, 2 * d), (particles.ident[lane], 0)
    kept, own = contribute(physics.rule, now.counter, key, m, v, in_cell(r, now.grid))
    particles.cell[lane] = cell_index(r, now.grid)
    store_particle(strip, i, 0, r + kept)
    place = np.uint64(np.uint32(particles.cell[lane])) * np.uint64(sums_length(len(physics.terms)))
    terms, tallied = terms_of(physics, m, v, own), optional(tally(physics.energy, m, v), 1)
    sums[place] += tallied
    add_values(sums, place + np.uint64(1), terms)
    note_ghost(worker, fluid, lane, terms, tallied)


@where(physics=has_solid)
def forget_leap(physics, room, lane, displacement):
    """Forget the clear distance where a particle went farther than a stride."""
    if leaps(physics.solid, displacement):
        forget(room, lane // LANES, 1 << (lane % LANES // FEW))


@scalar
def mass_in_lane(physics, particles, lane):
    """Mass of the particle in a lane, counted through the strips."""
    strip = particles.data[strip_at(lane // LANES, particles.rows)]
    return lane_mass(physics.masses, strip, lane % LANES, 2 * len(physics.zero))
