"""How particles lie in memory: blocks of 4096, each with one row per coordinate and velocity.

A block (x x x ... y y y ... vx vx vx ...) is one stretch of memory, rows at constant offsets, so
that LLVM can see that they do not overlap and vectorise the loop over a strip of 256 particles. A
strip stays in the first-level cache while all stages of a step pass over it, and the next strip
continues the same rows, which the hardware prefetches. Eight numbers of padding keep rows off the
same cache set. Loops run over all 256 lanes of a strip; the last, partly filled strip computes
nonsense in its spare lanes, which nothing ever adds up.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numba import njit, types
from numba.cpython.unsafe.tuple import tuple_setitem
from numba.extending import intrinsic

from mesokit.execute.cache import cached_kernel
from mesokit.scalar import by_type, dot, mul_add, scalar, written_out

LANES = 256  # particles of a strip, cells of a batch
BLOCK = 4096
ROW = BLOCK + 8
STRIPS = BLOCK // LANES
BLOCK_BITS = np.uint64(12)  # BLOCK = 2^12
SCRATCH_ROW = LANES + 8
LINE = 64  # bytes of a cache line
QUAD = 4  # numbers of a vector; so many records are turned into rows together

# Cells add up fixed-point numbers, because integer sums do not depend on the order of the terms.
# Adding 1.5 * 2^52 leaves the rounded number in the low bits of the mantissa; the constant's own
# bits, once for each particle, are taken off when the sum is read.
ROUNDER = 1.5 * 2.0**52
ROUNDER_BITS = int(np.float64(ROUNDER).view(np.int64))

# A loop over particles or cells: (thread, threads, ...), run by all threads of a team at once.
kernel = cached_kernel
inner = njit(nogil=True, error_model="numpy")  # a part of a kernel, compiled with it


def zeros(shape: int | tuple[int, ...], kind: Any = np.float64) -> Any:
    """An array of zeros that starts on a cache line: no vector of a row then straddles two."""
    size = int(np.prod(shape)) * np.dtype(kind).itemsize
    raw = np.zeros(size + LINE, np.uint8)
    start = -raw.ctypes.data % LINE
    return raw[start : start + size].view(kind).reshape(shape)


def blocks_for(particles: int) -> int:
    """Number of blocks that hold so many particles."""
    return -(-particles // BLOCK)


def strips_for(particles: int) -> int:
    """Number of strips that hold so many particles."""
    return -(-particles // LANES)


@intrinsic
def wide(typing_context: Any) -> Any:
    """Say, in the body of a kernel, that its loops are worth the widest vectors of the machine.

    LLVM by itself keeps to half of them, for processors that once slowed down with the others.
    """

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        # llvmlite knows only LLVM's own attributes; this one is the machine's, a pair of strings.
        set.add(builder.function.attributes, '"prefer-vector-width"="512"')
        return context.get_dummy_value()

    return types.void(), generate


@scalar
def record_length(numbers):
    """Length of a record of so many numbers: even, as they are moved in pairs."""
    return numbers + numbers % 2


@scalar
def sums_length(terms):
    """Length of the sums of a cell: the number of particles, so many terms, whole vectors."""
    return (terms + 1 + QUAD - 1) // QUAD * QUAD


@scalar
def share(number, thread, threads):
    """First and last + 1 of the things, out of a number, that are a thread's to do."""
    return number * thread // threads, number * (thread + 1) // threads


@scalar
def place(particle, rows, row):
    """Where a row's value for a particle, counted through the blocks, lies in memory."""
    block = np.uint64(particle) >> BLOCK_BITS
    lane = np.uint64(particle) & np.uint64(BLOCK - 1)
    return block * np.uint64(rows * ROW) + np.uint64(row * ROW) + lane


@scalar
def strip_of(data, number, rows):
    """The part of the blocks that holds a strip: row k of lane i is at k * ROW + i."""
    start = number // STRIPS * (rows * ROW) + number % STRIPS * LANES
    return data[start : start + (rows - 1) * ROW + LANES]


def load(strip: Any, i: Any, row: Any, like: Any) -> Any:
    """Lane i of consecutive rows of particles, as a tuple as long as `like`."""
    raise NotImplementedError


@by_type(load)
def _load(strip: Any, i: Any, row: Any, like: Any) -> Callable:
    line = "strip[(row + {k}) * ROW + i]"
    return written_out("strip, i, row, like", line, len(like), "({all},)", ROW=ROW)


def store(strip: Any, i: Any, row: Any, values: Any) -> Any:
    """Write a tuple into lane i of consecutive rows of particles."""
    raise NotImplementedError


@by_type(store)
def _store(strip: Any, i: Any, row: Any, values: Any) -> Callable:
    line = "strip[(row + {k}) * ROW + i] = values[{k}]"
    return written_out("strip, i, row, values", line, len(values), ROW=ROW)


def recall(scratch: Any, i: Any, like: Any) -> Any:
    """Lane i of a strip's scratch rows, as a tuple as long as `like`."""
    raise NotImplementedError


@by_type(recall)
def _recall(scratch: Any, i: Any, like: Any) -> Callable:
    line = "scratch[{k} * SCRATCH_ROW + i]"
    return written_out("scratch, i, like", line, len(like), "({all},)", SCRATCH_ROW=SCRATCH_ROW)


def note(scratch: Any, i: Any, values: Any) -> Any:
    """Write a tuple into lane i of a strip's scratch rows."""
    raise NotImplementedError


@by_type(note)
def _note(scratch: Any, i: Any, values: Any) -> Callable:
    line = "scratch[{k} * SCRATCH_ROW + i] = values[{k}]"
    return written_out("scratch, i, values", line, len(values), SCRATCH_ROW=SCRATCH_ROW)


@scalar
def fixed(x, scale):
    """x * scale rounded to a whole number, plus ROUNDER_BITS, as int64."""
    return np.float64(mul_add(x, scale, ROUNDER)).view(np.int64)


@scalar
def from_fixed(total, terms, scale):
    """A sum of `terms` fixed-point numbers as a float."""
    return float(total - np.int64(terms) * ROUNDER_BITS) * (1.0 / scale)


def mass_of(masses: Any, strip: Any, i: Any, row: Any) -> Any:
    """Mass of the particle in lane i: `masses` is (mass,) for all, or () for a row of masses."""
    raise NotImplementedError


@by_type(mass_of)
def _mass_of(masses: Any, strip: Any, i: Any, row: Any) -> Callable:
    if len(masses) == 1:
        return lambda masses, strip, i, row: masses[0]
    return lambda masses, strip, i, row: strip[row * ROW + i]


def mass_term(masses: Any, m: Any) -> Any:
    """(m,) where particles differ in mass, so that cells must add it up; () where they do not."""
    raise NotImplementedError


@by_type(mass_term)
def _mass_term(masses: Any, m: Any) -> Callable:
    if len(masses) == 1:
        return lambda masses, m: ()
    return lambda masses, m: (m,)


def energy_term(energy: Any, m: Any, v: Any) -> Any:
    """(m v^2,) where cells must know their energy; () where they need not."""
    raise NotImplementedError


@by_type(energy_term)
def _energy_term(energy: Any, m: Any, v: Any) -> Callable:
    if len(energy) == 1:
        return lambda energy, m, v: (m * dot(v, v),)
    return lambda energy, m, v: ()


def integers(values: Any) -> Any:
    """A tuple of int64 zeros as long as `values`."""
    raise NotImplementedError


@by_type(integers)
def _integers(values: Any) -> Callable:
    zeros = (np.int64(0),) * len(values)
    return lambda values: zeros


def read_sums(
    masses: Any, energy: Any, totals: Any, i: Any, like: Any, terms: Any, scales: Any
) -> Any:
    """Number, mass, momentum, sum of m v^2 (0 if not asked) and the rule's own sums of a cell."""
    raise NotImplementedError


@by_type(read_sums)
def _read_sums(
    masses: Any, energy: Any, totals: Any, i: Any, like: Any, terms: Any, scales: Any
) -> Callable:
    d, uniform, asked = len(like), len(masses) == 1, len(energy) == 1
    at_energy = d if uniform else d + 1
    own = at_energy + 1 if asked else at_energy

    def read(masses, energy, totals, i, like, terms, scales):
        n = totals[i]
        values = floats(totals, i, n, scales)
        mass = max(float(n), 1.0) * masses[0] if uniform else max(values[d], 1e-300)
        m_v_squared = values[at_energy] if asked else 0.0
        return float(n), mass, values[:d], m_v_squared, values[own:]

    return read


def count_images(image: Any, i: Any, crossed: Any) -> None:
    """Count the boxes that particle i crossed: one number for each axis, or () for none."""
    raise NotImplementedError


@by_type(count_images)
def _count_images(image: Any, i: Any, crossed: Any) -> Callable:
    if len(crossed) == 0:
        return lambda image, i, crossed: None

    def count(image, i, crossed):
        for k in range(len(crossed)):
            image[k, i] += np.int32(crossed[k])

    return count


def read_total(masses: Any, sums: Any, cell: Any, like: Any, terms: Any, scales: Any) -> Any:
    """Mass and momentum of a cell, added up over what the threads found."""
    raise NotImplementedError


@by_type(read_total)
def _read_total(masses: Any, sums: Any, cell: Any, like: Any, terms: Any, scales: Any) -> Callable:
    d, uniform = len(like), len(masses) == 1

    def read(masses, sums, cell, like, terms, scales):
        start = cell * sums_length(len(terms))
        n = np.int64(0)
        for t in range(sums.shape[0]):
            n += sums[t, start]
        momentum = like
        for k in range(d):
            total = np.int64(0)
            for t in range(sums.shape[0]):
                total += sums[t, start + 1 + k]
            momentum = tuple_setitem(momentum, k, from_fixed(total, n, scales[k]))
        total = np.int64(0)
        if not uniform:
            for t in range(sums.shape[0]):
                total += sums[t, start + 1 + d]
        mass = n * masses[0] if uniform else from_fixed(total, n, scales[d])
        return mass, momentum

    return read


def rounded(terms: Any, scales: Any) -> Any:
    """Each term as a fixed-point number."""
    raise NotImplementedError


@by_type(rounded)
def _rounded(terms: Any, scales: Any) -> Callable:
    line = "fixed(terms[{k}], scales[{k}])"
    return written_out("terms, scales", line, len(terms), "({all},)", fixed=fixed)


def fetch(values: Any, start: Any, like: Any) -> Any:
    """Consecutive values of an array from `start` (unsigned), as a tuple as long as `like`."""
    raise NotImplementedError


@by_type(fetch)
def _fetch(values: Any, start: Any, like: Any) -> Callable:
    line = "values[start + np.uint64({k})]"
    return written_out("values, start, like", line, len(like), "({all},)", np=np)


def put(values: Any, start: Any, given: Any) -> None:
    """Write a tuple to consecutive places of an array from `start` (unsigned)."""
    raise NotImplementedError


@by_type(put)
def _put(values: Any, start: Any, given: Any) -> Callable:
    line = "values[start + np.uint64({k})] = given[{k}]"
    return written_out("values, start, given", line, len(given), np=np)


def add_to(values: Any, start: Any, given: Any) -> None:
    """Add a tuple to consecutive places of an array from `start` (unsigned)."""
    raise NotImplementedError


@by_type(add_to)
def _add_to(values: Any, start: Any, given: Any) -> Callable:
    line = "values[start + np.uint64({k})] += given[{k}]"
    return written_out("values, start, given", line, len(given), np=np)


def floats(totals: Any, i: Any, n: Any, scales: Any) -> Any:
    """Lane i of the totals of n particles after the first row, as floats."""
    raise NotImplementedError


@by_type(floats)
def _floats(totals: Any, i: Any, n: Any, scales: Any) -> Callable:
    line = "from_fixed(totals[{k} * ROW + ROW + i], n, scales[{k}])"
    names = {"from_fixed": from_fixed, "ROW": SCRATCH_ROW}
    return written_out("totals, i, n, scales", line, len(scales), "({all},)", **names)
