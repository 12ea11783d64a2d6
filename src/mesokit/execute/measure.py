"""Sums over all particles that observables ask for; the same bits for any number of threads.

Each strip writes its own partial sum, and the partial sums are added in order.
"""

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.box import fold
from mesokit.elementary import sincos_turn
from mesokit.execute.layout import LANES, kernel, load, mass_of, share, strip_of
from mesokit.scalar import dot, scaled


@kernel
def totals(thread, threads, gate, physics, data, count, rows, like, out):
    """Momentum, sum of m v^2 and largest component of |v| in each strip: out (blocks, d + 2)."""
    d = len(like)
    first, last = share((count + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        strip = strip_of(data, b, rows)
        for i in range(min(LANES, count - b * LANES)):
            v = load(strip, i, d, like)
            m = mass_of(physics.masses, strip, i, 2 * d)
            for k in range(d):
                out[b, k] += m * v[k]
                out[b, d + 1] = max(out[b, d + 1], abs(v[k]))
            out[b, d] += m * dot(v, v)


@kernel
def bin_sums(thread, threads, gate, physics, box, data, count, rows, like, axes, bins, scales, out):
    """Number, mass, momentum and m v^2 in bins along one or two axes, as fixed-point sums.

    `axes` and `bins` hold two entries each; for a profile the second has one bin. `out` is
    (threads, bins, d + 3).
    """
    d = len(like)
    out = out[thread]
    first, last = share((count + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        strip = strip_of(data, b, rows)
        for i in range(min(LANES, count - b * LANES)):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            r, v, _ = fold(box, r, v, scaled(0.0, like))
            m = mass_of(physics.masses, strip, i, 2 * d)
            place = 0
            for k in range(2):
                x = int(r[axes[k]] / box.size[axes[k]] * bins[k])
                place = place * bins[k] + min(max(x, 0), bins[k] - 1)
            out[place, 0] += 1
            out[place, 1] += np.int64(np.rint(m * scales[1]))
            for k in range(d):
                out[place, 2 + k] += np.int64(np.rint(m * v[k] * scales[0]))
            out[place, 2 + d] += np.int64(np.rint(m * dot(v, v) * scales[2]))


@kernel
def modes(thread, threads, gate, physics, box, data, count, rows, like, waves, out):
    """Fourier sums of mass and momentum of each strip: out (blocks, waves, 1 + d, 2).

    `waves` are wave vectors over 2 pi, in turns per length.
    """
    d = len(like)
    first, last = share((count + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        strip = strip_of(data, b, rows)
        for i in range(min(LANES, count - b * LANES)):
            r, v = load(strip, i, 0, like), load(strip, i, d, like)
            r, v, _ = fold(box, r, v, scaled(0.0, like))
            m = mass_of(physics.masses, strip, i, 2 * d)
            for w in range(len(waves)):
                phase = 0.0
                for k in range(d):
                    phase += waves[w, k] * r[k]
                s, c = sincos_turn(phase - np.floor(phase))
                out[b, w, 0, 0] += m * c
                out[b, w, 0, 1] -= m * s
                for k in range(d):
                    out[b, w, 1 + k, 0] += m * v[k] * c
                    out[b, w, 1 + k, 1] -= m * v[k] * s


@kernel
def gather_by_id(
    thread, threads, gate, box, data, image, ident, count, rows, like, unwrapped, position, velocity,
    number,
):  # fmt: skip
    """Positions, velocities and images of particles with ident < len(position), by ident."""
    d = len(like)
    limit = len(position)
    first, last = share((count + LANES - 1) // LANES, thread, threads)
    for b in range(first, last):
        strip = strip_of(data, b, rows)
        for i in range(min(LANES, count - b * LANES)):
            j = b * LANES + i
            who = ident[j]
            if who < limit:
                r, v = load(strip, i, 0, like), load(strip, i, d, like)
                if unwrapped:
                    for k in range(d):
                        r = tuple_setitem(r, k, r[k] + image[k, j] * box.size[k])
                    for k in range(d):
                        position[who, k] = r[k]
                        velocity[who, k] = v[k]
                else:
                    r, v, n = fold(box, r, v, scaled(0.0, like))
                    for k in range(d):
                        position[who, k] = r[k]
                        velocity[who, k] = v[k]
                        number[who, k] = image[k, j] + np.int32(n[k])
