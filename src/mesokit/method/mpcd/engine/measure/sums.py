"""Sums over all particles for observables; the same bits for any number of threads.

The sums are of whole numbers: their order does not matter.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from mesokit.case.box import fold
from mesokit.kernels.kernel import kernel
from mesokit.loops.layout import LANES, lanes_in, share, strip_at, strips_in
from mesokit.method.mpcd.engine.cpu.stages import add_strip
from mesokit.method.mpcd.engine.cpu.strips.rows import lane_mass, load_particle, store_scratch
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.fixed_point import (
    add_fixed,
    add_integers,
    added_fixed,
    added_quanta,
    bits,
    from_bits,
    integers,
    quanta,
    rounded,
)
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.jit import elementwise, scalar
from mesokit.scalar.vector import dot, row, scaled


@kernel
def totals(worker, masses, particles, scales, out, fastest):
    """Momentum and sum of m v^2 of each strip, as whole numbers: out (strips, d + 1).

    `scales` (d + 1) of them are one unit; `fastest` (strips,) is the largest component of |v|.
    """
    data, rows = particles.data, particles.rows
    filling, d, zero = particles.filling, len(scales) - 1, scales[1:]
    first, last = share(strips_in(filling), worker.thread, worker.threads)
    # Integer sums for each strip, so the share of a thread changes nothing. The largest velocity is
    # compared by its bits: for positive floats these have the same order, with NaN at the top.
    for b in range(first, last):
        strip, momentum, energy = data[strip_at(b, rows)], integers(zero), np.int64(0)
        top = np.int64(0)
        for i in range(lanes_in(filling, b)):
            v = load_particle(strip, i, d, zero)
            m = lane_mass(masses, strip, i, 2 * d)
            momentum = added_quanta(scaled(m, v), scales[0], momentum)
            energy += quanta(m * dot(v, v), scales[d])
            top = max(top, largest_bits(v))
        add_integers(out[b], momentum + (energy,))
        largest = from_bits(top)
        fastest[b] = largest if largest == largest else math.inf


@scalar
def largest_bits(v):
    """The bits of the largest component of |v|: whole numbers in the same order, NaN at the top."""
    top = np.int64(0)
    for k in range(len(v)):
        top = max(top, bits(abs(v[k])))
    return top


class Bins(NamedTuple):
    """Bins along one or two axes, and memory: `number` holds 1.0 where there is no second axis."""

    axes: tuple
    number: tuple
    scales: tuple  # whole numbers per unit of momentum (d), mass and m v^2
    place: Any  # (threads, LANES)
    terms: Any  # (threads, ...)
    first: int  # of the strips that are read
    last: int  # and where they end


@kernel
def bin_sums(worker, zero, masses, box, particles, bins, sums):
    """Number, momentum, mass and m v^2 in bins, as fixed-point sums.

    `sums` is (threads, bins * (d + 3)), to be zero.
    """
    data, rows = particles.data, particles.rows
    filling, scales, d = particles.filling, bins.scales, len(zero)
    place, quanta, out = bins.place[worker.thread], bins.terms[worker.thread], sums[worker.thread]
    terms = integers(scales)
    first, last = share(bins.last - bins.first, worker.thread, worker.threads)
    # Bins are treated as the cells of a step. First, bin and rounded terms of each lane, as
    # vectors; then integer sums, of which each thread has its own.
    for b in range(bins.first + first, bins.first + last):
        strip = data[strip_at(b, rows)]
        for i in range(LANES):
            r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
            r, v, _ = fold(box, r, v, scaled(0.0, zero))
            m = lane_mass(masses, strip, i, 2 * d)
            place[i] = np.int32(bin_at(bins.axes, bins.number, box, r))
            store_scratch(quanta, i, rounded(moments_of(m, v), scales))
        add_strip(place, quanta, out, lanes_in(filling, b), terms, (), ())


@scalar
def bin_at(axes, number, box, r):
    """The bin of a place in the box, as a float; those of the second axis vary fastest."""
    index = 0.0
    for k in range(2):
        axis = axes[k]
        x = floor(r[axis] / box.size[axis] * number[k])
        x = x if x > 0.0 else 0.0  # also of a place that is no number
        index = index * number[k] + (x if x < number[k] else number[k] - 1.0)
    return index


@scalar
def moments_of(m, v):
    """Momentum (d), mass and m v^2."""
    return scaled(m, v) + (m, m * dot(v, v))


class Waves(NamedTuple):
    """Wave vectors over 2 pi, in turns per length, whole numbers per unit of the sums, and which
    particles count: from one number to before another."""

    turns: Any
    scale: float
    first: int
    last: int


@kernel
def modes(worker, zero, masses, box, particles, waves, out):
    """Fourier sums of mass and momentum as fixed-point sums: out (threads, waves, 2 (1 + d)).

    Each row holds mass times cosine and minus sine, then the same of each component of the
    momentum; each sum has a multiple of LANES terms, zero in spare lanes and for particles that do
    not count.
    """
    data, rows = particles.data, particles.rows
    filling, d = particles.filling, len(zero)
    first, last = share(strips_in(filling), worker.thread, worker.threads)
    # Wave by wave within a strip, which stays in the cache for all of them. Phases are reduced to
    # one turn before sine and cosine. Lanes that do not count are at rest at 0 and have mass 0, so
    # the loop has no branch: what was left in spare lanes may be no number.
    for b in range(first, last):
        strip = data[strip_at(b, rows)]
        lanes = lanes_in(filling, b)
        for w in range(len(waves.turns)):
            wave = row(waves.turns, w, zero)
            sums = integers((0.0, 0.0) + zero + zero)
            for i in range(LANES):
                r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
                r, v, _ = fold(box, r, v, scaled(0.0, zero))
                m = lane_mass(masses, strip, i, 2 * d)
                number = particles.ident[b * LANES + i]
                counts = i < lanes and waves.first <= number < waves.last
                r, v, m = if_counted(counts, r), if_counted(counts, v), m if counts else 0.0
                sums = added_fixed(part_in_wave(wave, m, r, v), waves.scale, sums)
            add_fixed(out[worker.thread, w], LANES, sums)


@elementwise
def if_counted(counts, values):
    """A tuple of numbers, or zeros where they do not count."""
    return "values[{k}] if counts else 0.0"


@scalar
def part_in_wave(wave, m, r, v):
    """Mass times cosine and minus sine, then the same of each component of the momentum."""
    phase = dot(wave, r)
    s, c = sincos_turn(phase - floor(phase))
    c, s = m * c, -m * s
    return (c, s) + scaled(c, v) + scaled(s, v)


class Looked(NamedTuple):
    """The particles to read, and the memory for their readings."""

    slots: Any  # by particle number: that among those to be read, or -1; or places in memory
    position: Any
    velocity: Any
    image: Any


@kernel
def gather_by_id(worker, zero, box, particles, unwrapped, looked):
    """Positions, velocities and images of those that have a slot, by their numbers."""
    first, last = share(strips_in(particles.filling), worker.thread, worker.threads)
    for b in range(first, last):
        for i in range(lanes_in(particles.filling, b)):
            slot = looked.slots[particles.ident[b * LANES + i]]
            if slot >= 0:
                look_at(b, i, zero, box, particles, unwrapped, looked, slot)


@kernel
def gather_at(worker, zero, box, particles, unwrapped, looked):
    """The same of those that `slots` lists, by their places in memory."""
    first, last = share(len(looked.slots), worker.thread, worker.threads)
    for slot in range(first, last):
        i = looked.slots[slot]
        look_at(i // LANES, i % LANES, zero, box, particles, unwrapped, looked, slot)


@scalar
def look_at(b, i, zero, box, particles, unwrapped, looked, slot):
    """Store position, velocity and images of lane i of strip b."""
    d, strip, j = len(zero), particles.data[strip_at(b, particles.rows)], b * LANES + i
    r, v = load_particle(strip, i, 0, zero), load_particle(strip, i, d, zero)
    crossed, image = scaled(0.0, zero), particles.image
    if not unwrapped:
        r, v, crossed = fold(box, r, v, crossed)
    for k in range(d):
        looked.position[slot, k] = r[k] + (image[k, j] * box.size[k] if unwrapped else 0.0)
        looked.velocity[slot, k] = v[k]
        looked.image[slot, k] = image[k, j] + np.int32(crossed[k])


@kernel
def central_energies(potential, squares):
    """Squared distances become the energies of pairs that are so far apart."""
    for i in range(len(squares)):
        squares[i] = central(potential, squares[i])[0]


@kernel
def angle_energies(potential, before, after, zero, out):
    """Energies of bonds (n, d) that follow one another."""
    for i in range(len(out)):
        out[i] = bend(potential, row(before, i, zero), row(after, i, zero))[0]
