"""The part of bodies, and of the particles near them, in the stress of a step.

A body is one particle at its centre X. It carries M (V - u)(V - u), as particles do. What it gives
a particle at x counts as that impulse times x - X, and so does what the collision gives its virtual
particles. Forces of gaps count with the separations of centres (Irving and Kirkwood 1950).
"""

import numpy as np  # noqa: F401  the text of a function below uses it

from mesokit.case.box import peculiar, slide
from mesokit.loops.layout import LANES, share, strip_at
from mesokit.method.mpcd.engine.bodies.state import (
    COUNT,
    LANE,
    MASS,
    PLACE,
    VELOCITY,
    R,
    V,
    load,
    of_kind,
)
from mesokit.method.mpcd.engine.cpu.stress import add_product, add_terms, carried, within_cell
from mesokit.method.mpcd.engine.cpu.strips.rows import lane_mass, load_particle
from mesokit.scalar.fixed_point import (
    ROUNDER_BITS,  # noqa: F401  the text of a function above uses it
    add_fixed,
    added_fixed,
    integers,
)
from mesokit.scalar.jit import elementwise, seldom
from mesokit.scalar.vector import added, added_scaled, products

BEFORE, AFTER = 0, 1  # the collision


@elementwise
def opposite_of(terms, sums):
    """Sums of the opposites of so many fixed-point numbers."""
    return "2 * np.int64(terms) * ROUNDER_BITS - sums[{k}]"


@seldom
def take_near_flux(physics, now, strip, chosen, near, tensor):
    """Take the particles near bodies, which have not flown yet, off the flux of their strip."""
    zero, d = physics.zero, len(physics.zero)
    sums = integers(products(zero, zero) + products(zero, zero))
    for j in range(near):
        i = chosen[j]
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        m = lane_mass(physics.masses, strip, i, 2 * d)
        sums = added_fixed(carried(now.box, now.grid, m, r, v), physics.stress_scale, sums)
    add_fixed(tensor, near, opposite_of(near, sums))


@seldom
def add_near_flux(thread, physics, now, fluid, bodies):
    """Add their flux at the end of their flight."""
    values, zero = bodies.values[thread], physics.zero
    for j in range(bodies.counters[thread, COUNT]):
        lane = bodies.numbers[thread, j, LANE]
        r, v = load(values, j, R, zero), load(values, j, V, zero)
        r, v, _ = slide(now.box, r, v, now.grid.shift)
        strip = fluid.particles.data[strip_at(lane // LANES, fluid.particles.rows)]
        m = lane_mass(physics.masses, strip, lane % LANES, 2 * len(zero))
        terms = carried(now.box, now.grid, m, r, v)
        add_terms(fluid.taken.tensor[0, lane // LANES], physics.stress_scale, terms)


@seldom
def add_body_flux(worker, physics, now, bodies, part):
    """Add what bodies carry, before or after the collision."""
    first, last = share(len(bodies.rows), worker.thread, worker.threads)
    for i in range(first, last):
        x, v = (
            load(bodies.rows, i, PLACE, physics.zero),
            load(bodies.rows, i, VELOCITY, physics.zero),
        )
        c = peculiar(now.box, x, v)
        tensor = bodies.tensor[worker.thread, part]
        add_product(tensor, physics.stress_scale, of_kind(bodies, i, MASS), c, c)


@seldom
def add_impulse(thread, physics, bodies, part, arm, impulse):
    """Add an impulse at an arm from the centre of a body that takes the opposite."""
    d = len(physics.zero)
    add_product(bodies.tensor[thread, part, d * d :], physics.stress_scale, 1.0, impulse, arm)


@seldom
def add_gas_gain(thread, physics, now, bodies, r, arm, gain):
    """Add what the collision gives a virtual particle at r, as if at the centre of its body."""
    d, from_corner = len(physics.zero), within_cell(added(r, now.grid.shift))
    place = added_scaled(from_corner, -1.0, arm)
    add_product(bodies.tensor[thread, AFTER, d * d :], physics.stress_scale, 1.0, gain, place)


@seldom
def add_gaps(thread, physics, bodies, virial):
    """Add impulses of gaps times separations."""
    d = len(physics.zero)
    add_terms(bodies.tensor[thread, AFTER, d * d :], physics.stress_scale, virial)
