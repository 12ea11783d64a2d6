"""The layout of particles in memory: blocks of 4096, each with one row per coordinate and velocity.

A block (x x x ... y y y ... vx vx vx ...) is one stretch of memory, rows at constant offsets, so
that LLVM can see that they do not overlap and vectorise the loop over a strip of 128 particles. A
strip stays in the first-level cache while all stages of a step pass over it, and the next strip
continues the same rows, which the hardware prefetches. The padding of a row is a strip and a cache
line long, so that the rows of one strip lie in different cache sets. Loops run over all 128 lanes
of a strip; the last, partly filled strip computes nonsense in its spare lanes, which nothing ever
adds up.

Molecules of N beads lie in groups of N strips in a row: strip k of a group holds bead k of 128
molecules, one to a lane, so that forces between beads need no gathers. A group may reach from one
block into the next; the last one may be partly filled. Single particles are molecules of one bead.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.scalar.jit import by_type, scalar

LANES = 128  # particles of a strip, cells of a batch
LAST_LANE = LANES - 1  # as a mask, it tells the compiler that a lane is not negative
BLOCK = 4096
ROW = BLOCK + LANES + 8
STRIPS = BLOCK // LANES
BLOCK_BITS, LANE_BITS = np.uint64(12), np.uint64(7)  # BLOCK = 2^12, LANES = 2^7
SCRATCH_ROW = LANES + 8
LINE = 64  # bytes of a cache line
OF_LINE = LINE // 8  # numbers of a cache line
QUAD = 4  # numbers of a vector; so many records are turned into rows together


def zeros(shape: int | tuple[int, ...], kind: Any = np.float64) -> Any:
    """An array of zeros that starts on a cache line: no vector of a row then straddles two."""
    size = int(np.prod(shape)) * np.dtype(kind).itemsize
    raw = np.zeros(size + LINE, np.uint8)
    start = -raw.ctypes.data % LINE
    return raw[start : start + size].view(kind).reshape(shape)


class Singles(NamedTuple):
    """The number of single particles in the strips."""

    molecules: int


class Molecules(NamedTuple):
    """The number of molecules in the strips, and of beads of each."""

    molecules: int
    beads: int


def blocks_for(particles: int) -> int:
    """Number of blocks that hold so many particles."""
    return -(-particles // BLOCK)


def strips_for(molecules: int, beads: int = 1) -> int:
    """Number of strips that hold so many molecules."""
    return -(-molecules // LANES) * beads


def places_of_beads(molecules: int, beads: int) -> Any:
    """Places of the beads of each molecule (molecules, beads), counted through the strips."""
    molecule = np.arange(molecules)[:, None]
    return (molecule // LANES * beads + np.arange(beads)) * LANES + molecule % LANES


def by_number(numbers: Any, rows: Any) -> Any:
    """Rows (n, ...) in the order of memory, by the particle numbers (n,) that they have there."""
    found = np.empty(rows.shape, rows.dtype)
    found[numbers] = rows
    return found


@by_type
def beads_of(filling):
    """Number of beads of each molecule (a literal 1 for single particles)."""
    if filling.instance_class is Singles:
        return lambda filling: 1
    return lambda filling: filling.beads


@scalar
def groups_in(filling):
    """Number of groups of strips, one strip in each for every bead."""
    return (filling.molecules + LANES - 1) // LANES


@scalar
def strips_in(filling):
    """Number of strips that hold particles."""
    return groups_in(filling) * beads_of(filling)


@scalar
def lanes_in(filling, strip):
    """Number of lanes of a strip that hold particles."""
    return min(LANES, filling.molecules - strip // beads_of(filling) * LANES)


@by_type
def place_of_bead(filling, molecule, bead):
    """The place of a bead of a molecule, counted through the strips."""
    return _molecule if filling.instance_class is Singles else _in_group


def _molecule(filling, molecule, bead):
    return molecule


def _in_group(filling, molecule, bead):
    group, lane = np.uint64(molecule) >> LANE_BITS, np.uint64(molecule) & np.uint64(LANES - 1)
    strip = group * np.uint64(filling.beads) + np.uint64(bead)
    return np.int64((strip << LANE_BITS) + lane)


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
    """The index in memory of a row's value for a particle, which is counted through the blocks."""
    block = np.uint64(particle) >> BLOCK_BITS
    lane = np.uint64(particle) & np.uint64(BLOCK - 1)
    return block * np.uint64(rows * ROW) + np.uint64(row * ROW) + lane


@scalar
def strip_at(number, rows):
    """The part of the blocks that holds a strip: row k of lane i is at k * ROW + i.

    A slice: functions that count no users of arrays (`scalar.seldom`) can neither return a view
    nor give one back.
    """
    start = number // STRIPS * (rows * ROW) + number % STRIPS * LANES
    return slice(start, start + (rows - 1) * ROW + LANES)
