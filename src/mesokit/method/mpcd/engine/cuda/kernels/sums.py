"""What one thread does for a particle in a reading: sums of whole numbers, and looks at some.

Sums are spread over rows, one for each block of threads, so that few threads add to one number.
Whole numbers that could overflow are added up as high and low halves.
"""

from typing import NamedTuple

import numpy as np

from mesokit.case.box import fold
from mesokit.devices.device import BLOCK
from mesokit.method.mpcd.engine.cuda.kernels.rows import (
    from_rows,
    mass_of_number,
    whole_numbers,
)
from mesokit.method.mpcd.engine.measure.sums import bin_at, largest_bits, moments_of, part_in_wave
from mesokit.scalar.fixed_point import (
    HALF,
    LOW,
    added_fixed,
    added_quanta,
    integers,
    quanta,
    rounded,
)
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import (
    add_word,
    add_words,
    put_real,
    put_whole,
    raise_to,
    reals,
    whole,
    word,
)
from mesokit.scalar.vector import dot, scaled


@scalar
def add_motion(i, physics, scales, fluid, sums, fastest):
    """Momentum and m v^2 of a particle to the row of its block (rows, d + 1), and the largest
    component of |v| to that of `fastest` (rows,)."""
    v, d = from_rows(fluid.v, i, physics.zero), len(physics.zero)
    m, row = mass_of_number(physics, fluid.kinds, whole(fluid.ident, i)), i // BLOCK
    momentum = added_quanta(scaled(m, v), scales[0], integers(v))
    add_words(sums, row * (d + 1), momentum + (quanta(m * dot(v, v), scales[d]),))
    raise_to(fastest, row, largest_bits(v))


class SpreadBins(NamedTuple):
    """SpreadBins along one or two axes: `number` holds 1.0 where there is no second axis.

    `scales` are the whole numbers per unit of momentum (d), mass and m v^2; `sums` is the address
    of (copies, bins, 2 (d + 3)) whole numbers.
    """

    axes: tuple
    number: tuple
    scales: tuple
    copies: int
    sums: int


@scalar
def add_to_bin(i, physics, box, fluid, bins):
    """Number, momentum, mass and m v^2 of a particle to its bin, as high and low halves."""
    r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
    r, v, _ = fold(box, r, v, scaled(0.0, physics.zero))
    m = mass_of_number(physics, fluid.kinds, whole(fluid.ident, i))
    terms = (np.int64(1),) + whole_numbers(rounded(moments_of(m, v), bins.scales))
    place = np.int64(bin_at(bins.axes, bins.number, box, r))
    place += i // BLOCK % bins.copies * np.int64(bins.number[0] * bins.number[1])
    for k in range(len(terms)):
        start = (place * len(terms) + k) * 2
        add_word(bins.sums, start, terms[k] >> HALF)
        add_word(bins.sums, start + 1, terms[k] & LOW)


@scalar
def add_to_waves(i, physics, box, fluid, waves, copies, sums):
    """The part of a particle in each wave, if it counts (see `measure.sums.Waves`).

    `sums` is (copies, waves, 2 (1 + d)); `waves` has the address of the wave vectors, how many
    there are, the scale of the sums, and between which numbers particles count.
    """
    turns, many, scale, first, last = waves
    number = whole(fluid.ident, i)
    if first <= number and number < last:
        r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
        r, v, _ = fold(box, r, v, scaled(0.0, physics.zero))
        m, d = mass_of_number(physics, fluid.kinds, number), len(physics.zero)
        start = i // BLOCK % copies * many
        for w in range(many):
            part = part_in_wave(reals(turns, w * d, physics.zero), m, r, v)
            terms = whole_numbers(added_fixed(part, scale, integers(part)))
            add_words(sums, (start + w) * len(terms), terms)


@scalar
def look_at_place(j, physics, box, fluid, unwrapped, places, seen):
    """Position, velocity and images of the particle at the jth of these places (int64)."""
    look_at_particle(word(places, j), j, physics, box, fluid, unwrapped, seen)


@scalar
def look_by_slot(i, physics, box, fluid, unwrapped, slots, seen):
    """The same of a particle whose number has a slot (int32), which is -1 for all others."""
    slot = whole(slots, whole(fluid.ident, i))
    if slot >= 0:
        look_at_particle(i, slot, physics, box, fluid, unwrapped, seen)


@scalar
def look_at_particle(i, slot, physics, box, fluid, unwrapped, seen):
    """Write the particle at place i to row `slot` of positions, velocities and images (n, d)."""
    d = len(physics.zero)
    r, v = from_rows(fluid.r, i, physics.zero), from_rows(fluid.v, i, physics.zero)
    crossed = scaled(0.0, physics.zero)
    if unwrapped == 0:
        r, v, crossed = fold(box, r, v, crossed)
    for k in range(d):
        image = whole(fluid.image[k], i)
        away = image * box.size[k] if unwrapped != 0 else 0.0
        put_real(seen[0], slot * d + k, r[k] + away)
        put_real(seen[1], slot * d + k, v[k])
        put_whole(seen[2], slot * d + k, image + np.int64(crossed[k]))
