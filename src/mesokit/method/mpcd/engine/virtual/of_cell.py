"""What virtual particles of a cell are drawn from, and what they bring to it, as numbers.

The processor does this for batches of cells, a device with a thread for each (see `per_cell` and
`cuda.virtual`).
"""

# ruff: noqa: F401  lines written out as text use what is imported here

import math
from typing import NamedTuple

import numpy as np

from mesokit.geometry.protocol import surface_flow
from mesokit.geometry.solids.clearance import offsets_along
from mesokit.geometry.solids.cut_cube import share_and_depth
from mesokit.method.mpcd.collision.protocol import collide, contribute
from mesokit.method.mpcd.engine.cpu.bounce import body_takes
from mesokit.method.mpcd.engine.cpu.grid import in_cell
from mesokit.method.mpcd.engine.cpu.physics import momentum_scale
from mesokit.method.mpcd.engine.cpu.strips.cell_energy import (
    many_energy_term,
    many_tally,
    needs_energy,
)
from mesokit.method.mpcd.engine.virtual.gradient import flow_at
from mesokit.method.mpcd.engine.virtual.particles import MOST
from mesokit.scalar.fixed_point import ROUNDER_BITS, rounded
from mesokit.scalar.gamma import gamma_number, likely
from mesokit.scalar.intrinsics import floor, with_item
from mesokit.scalar.jit import elementwise, scalar
from mesokit.scalar.random import FIRST_VIRTUAL, VIRTUAL_NUMBER, VIRTUAL_VELOCITY, normals, words
from mesokit.scalar.vector import added, added_scaled, dot, scaled


@scalar
def moved_from_middle(solid, grid, zero):
    """The displacement of the grid from the middle of its interval of offsets, in cells."""
    many = offsets_along(solid, zero)
    for k in range(len(zero)):
        within = grid.origin[k] * many
        zero = with_item(zero, k, (within - floor(within) - 0.5) / many)
    return zero


@scalar
def cut_at(density, height, n, middle, moved):
    """Mean number of particles in the solid part of a cell, their mean depth, and mean place.

    Plane and cell are shifted against each other by the grid shift of the step, in cells. The
    height of the middle over the plane changes, the normal does not.
    """
    height -= dot(n, moved)
    part, depth = share_and_depth(height, n)
    # all fluid or all solid: then no particle of the fluid is there
    cut = (part > 0.0) & (part < 1.0)
    place = added_scaled(added_scaled(middle, -1.0, moved), -(height + depth), n)
    return density * part if cut else 0.0, depth, place


@scalar
def velocity_in_solid(virtual, solid, term, piece, above, r):
    """Mean velocity of virtual particles at r, at a height above the surface that is negative.

    Where nothing is known of a piece of surface its number is -1.
    """
    u = surface_flow(solid, term, r)
    if piece >= 0:
        u = added(u, flow_at(virtual.rates, piece, above, r))
    return u


@scalar
def velocity_of_gas(physics, m, counter, number):
    """Thermal velocity of a virtual particle with a number, or of one of a cell with a key."""
    a, b, c, e = words(counter, VIRTUAL_VELOCITY, number, 0)
    return scaled(math.sqrt(physics.kT / m), normals(physics.zero, a, b, c, e))


@scalar
def likely_energy(counter, key, number, zero):
    """Energy over kT of so many particles about their mean velocity; -1 where in doubt."""
    _, _, a, b = words(counter, VIRTUAL_NUMBER, key, 0)
    value, sure = likely(a, b, max(len(zero) * (number - 1.0), 0.0))
    return value if sure else -1.0


class Brought(NamedTuple):
    """What the virtual particles of a cell bring to it together: mass, mean velocity before the
    collision, the velocity that they keep until then, fixed-point terms, and what counts them."""

    mass: float
    v: tuple
    kept: tuple
    terms: tuple
    tallied: int


@scalar
def brought_together(physics, now, key, number, r, v, inner):
    """What so many virtual particles (int64) bring to the cell of a key.

    `v` is their mean velocity, `inner` their `likely_energy`.
    """
    (m,), d, m_v_squared = physics.masses, len(physics.zero), 0.0
    if needs_energy(physics.energy):
        if inner < 0.0:
            inner = gamma_number(float(d * (number - 1)), now.counter, VIRTUAL_NUMBER, key)
        m_v_squared = inner * (2.0 * physics.kT)
    identity = (FIRST_VIRTUAL + key * MOST, 0)
    return brought_by_many(physics, now, identity, Many(number, m * number, m_v_squared), r, v)


class Many(NamedTuple):
    """Virtual particles as one: number, mass, and sum of m v^2 about their mean velocity."""

    number: np.int64
    mass: float
    inner: float


@scalar
def brought_by_many(physics, now, identity, many, r, v):
    """What virtual particles with the mean velocity v bring together to the cell of r."""
    number, mass, m_v_squared = many
    kept, own = contribute(physics.rule, now.counter, identity, mass, v, in_cell(r, now.grid))
    for k in range(len(v)):
        m_v_squared += mass * v[k] * v[k]
    terms = scaled(mass, v) + many_energy_term(physics.energy, m_v_squared) + own
    whole = _of_many(number, rounded(terms, physics.scales))
    tallied = many_tally(physics.energy, number, m_v_squared)
    return Brought(mass, v, kept, whole, tallied)


@elementwise
def _of_many(number, terms):
    """Fixed-point terms of so many particles, which are rounded one by one elsewhere."""
    return "terms[{k}] + np.int64(number - 1) * np.int64(ROUNDER_BITS)"


@scalar
def mean_velocity(u, thermal, number):
    """Of so many particles whose flow is u, from the thermal velocity of one."""
    return added_scaled(u, 1.0 / math.sqrt(float(number)), thermal)


@scalar
def take_gain(physics, grid, needed, particles, r, term, impulse):
    """Add to an impulse what virtual particles at r gain by the collision: (mass, v, v kept)."""
    mass, v, kept = particles
    after = collide(physics.rule, needed, kept, in_cell(r, grid))
    given = scaled(mass, added_scaled(after, -1.0, v))
    body_takes(impulse, physics.solid, term, r, given, momentum_scale(physics))
