"""What one thread does for a particle in a step: collide, fly, and bring its part to its cell.

Time levels are those of the CPU's sweep: the pending collision at t, the flight from t to t + dt,
the sums of the cells at t + dt.
"""

import numpy as np

from mesokit.case.box import slide
from mesokit.devices.device import BLOCK
from mesokit.devices.records import add_record
from mesokit.geometry.protocol import touches
from mesokit.geometry.solids.bodies import Bodies, cube_of
from mesokit.loops.layout import beads_of, record_length, sums_length
from mesokit.method.mpcd.collision.protocol import collide
from mesokit.method.mpcd.engine.cpu.bounce import fly_among
from mesokit.method.mpcd.engine.cpu.grid import cell_index, in_cell
from mesokit.method.mpcd.engine.cpu.groups import COLLIDE, MEASURE_STRESS, STREAM
from mesokit.method.mpcd.engine.cpu.physics import field_of, has_solid
from mesokit.method.mpcd.engine.cpu.sort import fold_with
from mesokit.method.mpcd.engine.cpu.stress import carried
from mesokit.method.mpcd.engine.cpu.strips.terms import brought
from mesokit.method.mpcd.engine.cuda.kernels.rows import (
    count_crossed,
    from_rows,
    mass_of_number,
    to_rows,
    whole_numbers,
)
from mesokit.method.mpcd.streaming import fall, halfway, vector
from mesokit.scalar.fixed_point import added_fixed, integers
from mesokit.scalar.jit import by_type, optional, scalar
from mesokit.scalar.pointer import add_words, put_whole, reals, short, take_number, whole


@scalar
def sweep(i, physics, now, fluid):
    """The pending collision, the flight, and what the particle brings to its next cell."""
    r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
    v = collide_particle(i, physics, now, fluid, r, v)
    if now.flags & STREAM:
        v = stream_particle(i, physics, now, fluid, r, v)
    to_rows(fluid.v, i, v)


@by_type
def stream_particle(i, physics, now, fluid, r, v):
    """The flight of a particle into its next cell; the velocity that it keeps.

    Among solids a particle that may meet one is only put on a list: its flight has code of its own
    (`bounce_listed`), which would take registers from all others here.
    """
    return _stream_among if has_solid(physics) else _stream_freely


def _stream_freely(i, physics, now, fluid, r, v):
    r, v = fall(r, v, halfway(physics.field, r, v, physics.timestep), physics.timestep)
    return bring(i, physics, now, fluid, r, v)


def _stream_among(i, physics, now, fluid, r, v):
    a = halfway(physics.field, r, v, physics.timestep)
    clear = around(physics.solid, r)
    if touches(physics.solid, clear, r, v, vector(a, r), physics.timestep):
        put_whole(fluid.listed, take_number(fluid.waiting, 0, 1), i)
        return v
    r, v = fall(r, v, a, physics.timestep)
    return bring(i, physics, now, fluid, r, v)


@scalar
def collide_particle(i, physics, now, fluid, r, v):
    """Velocity after the pending collision, if there is one."""
    if now.flags & COLLIDE:
        start = np.int64(cell_index(r, now.old)) * record_length(len(physics.coefficients))
        needed = reals(fluid.coefficients, start, physics.coefficients)
        v = collide(physics.rule, needed, v, in_cell(r, now.old))
        if not now.flags & STREAM:
            add_stress(i, physics, now, now.old, fluid, 1, r, v)
    return v


@by_type
def around(solid, r):
    """Square of the distance that is surely clear around a place: (d,) if it is in tables."""
    if solid.instance_class is not Bodies:
        return lambda solid, r: ()

    def looked_up(solid, r):
        stride = np.float32(solid.stride * solid.stride)
        return (min(stride, np.float32(short(solid.clear, np.int64(cube_of(solid, r))))),)

    return looked_up


@scalar
def bounce_listed(thread, physics, now, fluid, threads):
    """The same flight with reflections, for every `threads`th particle on the list."""
    for j in range(thread, whole(fluid.waiting, 0), threads):
        i = whole(fluid.listed, j)
        r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
        number = whole(fluid.ident, i)
        particle = number, mass_of_number(physics, fluid.kinds, number)
        r, v = fly_among(physics, now.counter, particle, r, v, fluid.impulse)
        to_rows(fluid.v, i, bring(i, physics, now, fluid, r, v))


@scalar
def bring(i, physics, now, fluid, r, v):
    """Store the place, add the particle to the sums of its cell; the velocity that it keeps."""
    r, v, crossed = slide(now.box, r, v, now.grid.shift)
    count_crossed(fluid.image, i, crossed)
    add_stress(i, physics, now, now.grid, fluid, 0, r, v)
    number = whole(fluid.ident, i)
    m = mass_of_number(physics, fluid.kinds, number)
    kept, terms, counted = brought(physics, now, number, m, r, v)
    start = np.int64(cell_index(r, now.grid)) * sums_length(len(physics.terms))
    add_record(fluid.adds, fluid.sums, start, padded((np.int64(optional(counted, 1)),) + terms))
    to_rows(fluid.r, i, r)
    return kept


@by_type
def padded(values):
    """A record as long as it is in memory: with zeros, which change no sum."""
    more = (0,) * (sums_length.py_func(len(values) - 1) - len(values))
    return lambda values: values + more


@by_type
def add_stress(i, physics, now, grid, fluid, part, r, v):
    """The part of a particle in the stress, to the row of its block (rows, 2 d^2), at the step of
    which it is measured; `part` is 0 before the collision and 1 after it."""
    if len(field_of(fluid, "tensor")) == 0:
        return lambda i, physics, now, grid, fluid, part, r, v: None

    def add(i, physics, now, grid, fluid, part, r, v):
        if now.flags & MEASURE_STRESS:
            m = mass_of_number(physics, fluid.kinds, whole(fluid.ident, i))
            flux = carried(now.box, grid, m, r, v)
            terms = whole_numbers(added_fixed(flux, physics.stress_scale, integers(flux)))
            add_words(fluid.tensor[part], i // BLOCK * len(terms), terms)

    return add


@scalar
def wrap_molecule(i, filling, zero, box, fluid):
    """Move a molecule to its image in the box, and count the boxes that each bead crossed."""
    for k in range(beads_of(filling) - 1, -1, -1):  # the first bead decides for all: it is last
        place = i + k * fluid.molecules
        r, v = from_rows(fluid.r, place, zero), from_rows(fluid.v, place, zero)
        r, v, crossed = fold_with(filling, box, r, v, from_rows(fluid.r, i, zero))
        to_rows(fluid.r, place, r)
        to_rows(fluid.v, place, v)
        count_crossed(fluid.image, place, crossed)
