"""Sums over all particles that observables ask for; the same bits for any number of threads.

Each strip writes its own partial sum, to be added in order; or the sums are of whole numbers.
"""

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.box import fold
from mesokit.elementary import sincos_turn
from mesokit.execute.cache import kernel
from mesokit.execute.fixed_point import ROUNDER_BITS, fixed, integers, rounded
from mesokit.execute.layout import LANES, lanes_in, share, strip_at, strips_in
from mesokit.execute.rows import load, mass_of, note
from mesokit.execute.stages import add_strip
from mesokit.potential.angle import bend
from mesokit.potential.protocol import central
from mesokit.scalar import dot, scalar, scaled


@kernel
def totals(thread, threads, gate, physics, data, filling, rows, like, out):
    """Momentum, sum of m v^2 and largest component of |v| in each strip: out (blocks, d + 2)."""
    d = len(like)
    first, last = share(strips_in(filling), thread, threads)
    for b in range(first, last):
        strip = data[strip_at(b, rows)]
        for i in range(lanes_in(filling, b)):
            v = load(strip, i, d, like)
            m = mass_of(physics.masses, strip, i, 2 * d)
            for k in range(d):
                out[b, k] += m * v[k]
                out[b, d + 1] = max(out[b, d + 1], abs(v[k]))
            out[b, d] += m * dot(v, v)


@kernel
def bin_sums(
    thread, threads, gate, physics, box, data, filling, rows, like, axes, bins, scales, scratch, out
):  # fmt: skip
    """Number, momentum, mass and m v^2 in bins along one or two axes, as fixed-point sums.

    `axes` and `bins` hold two entries each; for a profile the second has one bin. `out` is
    (threads, bins * (d + 3)), to be zero.
    """
    d = len(like)
    place, quanta = scratch
    place, quanta, out = place[thread], quanta[thread], out[thread]
    terms = integers(scales)
    first, last = share(strips_in(filling), thread, threads)
    for b in range(first, last):
        strip = data[strip_at(b, rows)]
        for i in range(LANES):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            r, v, _ = fold(box, r, v, scaled(0.0, like))
            m = mass_of(physics.masses, strip, i, 2 * d)
            index = 0.0
            for k in range(2):
                x = np.floor(r[axes[k]] / box.size[axes[k]] * bins[k])
                index = index * bins[k] + min(max(x, 0.0), bins[k] - 1.0)
            place[i] = np.int32(index)
            note(quanta, i, rounded(scaled(m, v) + (m, m * dot(v, v)), scales))
        add_strip(place, quanta, out, lanes_in(filling, b), terms, ())


@kernel
def modes(thread, threads, gate, physics, box, data, filling, rows, like, waves, scale, out):
    """Fourier sums of mass and momentum as fixed-point sums: out (threads, waves, 2 (1 + d)).

    `waves` are wave vectors over 2 pi, in turns per length. Each row holds mass times cosine and
    minus sine, then the same of each component of the momentum; each sum has a multiple of LANES
    terms, zero in spare lanes.
    """
    d = len(like)
    first, last = share(strips_in(filling), thread, threads)
    for b in range(first, last):
        strip = data[strip_at(b, rows)]
        lanes = lanes_in(filling, b)
        for w in range(len(waves)):
            wave = load_row(waves, w, like)
            sums = integers((0.0, 0.0) + like + like)
            for i in range(LANES):
                r, v = load(strip, i, 0, like), load(strip, i, d, like)
                r, v, _ = fold(box, r, v, scaled(0.0, like))
                m = mass_of(physics.masses, strip, i, 2 * d)
                m = m if i < lanes else 0.0
                phase = dot(wave, r)
                s, c = sincos_turn(phase - np.floor(phase))
                c, s = m * c, -m * s
                values = (c, s) + scaled(c, v) + scaled(s, v)
                for k in range(len(sums)):
                    sums = tuple_setitem(sums, k, sums[k] + fixed(values[k], scale))
            for k in range(len(sums)):
                out[thread, w, k] += sums[k] - np.int64(LANES * ROUNDER_BITS)


@scalar
def load_row(vectors, i, like):
    """One row of an array of vectors as a tuple."""
    for k in range(len(like)):
        like = tuple_setitem(like, k, vectors[i, k])
    return like


@kernel
def gather_by_id(
    thread, threads, gate, box, data, image, ident, slots, filling, rows, like, unwrapped, position,
    velocity, number,
):  # fmt: skip
    """Positions, velocities and images of particles that have a slot: slots[ident], or -1."""
    d = len(like)
    first, last = share(strips_in(filling), thread, threads)
    for b in range(first, last):
        strip = data[strip_at(b, rows)]
        for i in range(lanes_in(filling, b)):
            j = b * LANES + i
            slot = slots[ident[j]]
            if slot < 0:
                continue
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            crossed = scaled(0.0, like)
            if not unwrapped:
                r, v, crossed = fold(box, r, v, crossed)
            for k in range(d):
                position[slot, k] = r[k] + (image[k, j] * box.size[k] if unwrapped else 0.0)
                velocity[slot, k] = v[k]
                number[slot, k] = image[k, j] + np.int32(crossed[k])


@kernel
def central_energies(potential, squares):
    """Squared distances become the energies of pairs that are so far apart."""
    for i in range(len(squares)):
        squares[i] = central(potential, squares[i])[0]


@kernel
def angle_energies(potential, before, after, like, out):
    """Energies of bonds (n, d) that follow one another."""
    for i in range(len(out)):
        out[i] = bend(potential, load_row(before, i, like), load_row(after, i, like))[0]
