"""Virtual particles of a slit: a gas in the two layers of cells that the plates cut."""

from typing import Any, NamedTuple

from mesokit.execute.cpu.bounce import take
from mesokit.execute.cpu.groups import MEASURE_WALLS
from mesokit.execute.cpu.physics import momentum_scale
from mesokit.execute.cpu.stages import (
    add_strip,
    bin_strip,
    collide_strip,
    gather_strip,
)
from mesokit.execute.cpu.strips.cell_energy import tally
from mesokit.execute.cpu.strips.layout import LANES, share, strip_at
from mesokit.execute.cpu.strips.rows import load_particle, mass_of, store_particle
from mesokit.execute.virtual.gas import thermal
from mesokit.geometry.protocol import closes, lever, side
from mesokit.scalar.cache import inner
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import VIRTUAL_POSITION, VIRTUAL_VELOCITY, unit_open, words
from mesokit.scalar.vector import added, first, scaled


class SlitParticles(NamedTuple):
    """The virtual particles of a slit, which lie in strips after those of the fluid."""

    number: int
    strips: int
    first_strip: int
    rates: Any  # (2, d) how fast the fluid's velocity rises with the distance from either plate


def fill_slit(team, now, physics, fluid, walls):
    """A gas in the solid part of cut cells at t + dt, and its part in the sums of these cells."""
    _fill(team, now, physics, fluid, walls)


@inner
def _fill(team, now, physics, fluid, walls):
    virtual, particles, scratch = walls.slit, fluid.particles, fluid.scratch
    terms, impulse = scratch.terms[team.thread], fluid.taken.impulse[team.thread]
    sums, zero = fluid.cells.sums[team.thread], physics.zero
    start, end = share(virtual.strips, team.thread, team.threads)
    for s in range(start, end):
        b = virtual.first_strip + s
        places, lanes = slice(b * LANES, (b + 1) * LANES), min(LANES, virtual.number - s * LANES)
        strip, cell = particles.data[strip_at(b, particles.rows)], particles.cell[places]
        fill_strip(physics, now, strip, s * LANES, virtual.rates)
        if now.flags & MEASURE_WALLS:
            take_momentum(physics, strip, lanes, impulse, -1.0)
        bin_strip(physics, now, strip, cell, particles.ident[places], terms)
        for i in range(lanes):
            if side(physics.solid, load_particle(strip, i, 0, zero)) == 2:
                cell[i] = fluid.cells.number
        add_strip(cell, terms, sums, lanes, physics.terms, tally(physics.energy, 0.0, zero))


def slit_recoil(team, now, physics, fluid, walls):
    """What the plates take by the collision of their virtual particles."""
    _recoil(team, now, physics, fluid, walls)


@inner
def _recoil(team, now, physics, fluid, walls):
    if not now.flags & MEASURE_WALLS:
        return
    virtual, particles, scratch = walls.slit, fluid.particles, fluid.scratch
    gathered, impulse = scratch.coefficients[team.thread], fluid.taken.impulse[team.thread]
    start, end = share(virtual.strips, team.thread, team.threads)
    for s in range(start, end):
        b = virtual.first_strip + s
        strip, cell = particles.data[strip_at(b, particles.rows)], particles.cell[b * LANES :]
        gather_strip(cell, fluid.cells.coefficients, gathered, physics.coefficients)
        collide_strip(physics, now.grid, strip, gathered)
        take_momentum(physics, strip, min(LANES, virtual.number - s * LANES), impulse, 1.0)


@scalar
def take_momentum(physics, strip, count, impulse, sign):
    """Add the momentum of virtual particles, as part of the wall behind which they lie."""
    zero, scale = physics.zero, momentum_scale(physics)
    d = len(zero)
    for i in range(count):
        r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
        surface = side(physics.solid, r)
        if surface < 2:
            m = mass_of(physics.masses, strip, i, 2 * d)
            take(impulse, surface, lever(physics.solid, surface, r), scaled(sign * m, v), scale)


@scalar
def fill_strip(physics, now, strip, number, rates):
    """Virtual particles: a thermal gas of the fluid's density in the solid part of cut cells.

    Together the two layers of cut cells of a slit hold one layer of cells of solid, whatever the
    shift; each particle has a place in that layer, drawn anew at each step, and so belongs to the
    lower or the upper plate.
    """
    zero, counter, shift = physics.zero, now.counter, now.grid.shift
    d = len(zero)
    lower, upper = zero, zero
    for k in range(d):
        lower = with_item(lower, k, rates[0, k])
        upper = with_item(upper, k, rates[1, k])
    for i in range(LANES):
        a, b, c, _ = words(counter, VIRTUAL_POSITION, number + i, 0)
        place = first((unit_open(a), unit_open(b), unit_open(c)), zero)
        r, u = closes(physics.solid, place, shift, lower, upper)
        m = mass_of(physics.masses, strip, i, 2 * d)
        u = added(u, thermal(physics, m, counter, VIRTUAL_VELOCITY, number + i, 0))
        store_particle(strip, i, 0, r + u)
