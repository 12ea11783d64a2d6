"""Synchronous sublattices: blocks of a lattice at the same time, on threads (Shim and Amar 2005).

Each block is cut into sectors, two along each axis. In turn, in a random order, one sector of all
blocks goes on by a cycle of time, as if all else stood still. No two sectors that are at work touch
a site in common. Blocks belong to the case, and random numbers to the block: the bits do not depend
on the number of threads. The law is exact in the limit of short cycles.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.kernels.kernel import kernel
from mesokit.loops.threads import barrier
from mesokit.method.kinetic_monte_carlo.engine.change import happen, known, settle_rim
from mesokit.method.kinetic_monte_carlo.engine.choice import chance, choose, total_rate
from mesokit.method.kinetic_monte_carlo.engine.events import AHEAD, Numbers, draw
from mesokit.method.kinetic_monte_carlo.lattice.grid import BITS, Grid, places
from mesokit.scalar.jit import scalar
from mesokit.scalar.random import METHOD, Counter, words

SECTOR_EVENT = METHOD + np.uint64(91)  # purposes of random numbers
SECTOR_ORDER = METHOD + np.uint64(92)
REACH = 2  # sites: how far beyond a sector an event may change the rate of one within it
U = np.uint64


class Blocks(NamedTuple):
    """The blocks of a lattice, and how far each thread has come.

    seed. sectors: of a block. blocks: how many. length: a cycle of time. rim: (parts * near,)
    places of the sites near the rim of each sector. near: how many. numbers: random numbers of
    each thread. happened: (threads, so many) events by process and direction, each row in
    lines of the cache of its own.
    """

    seed: np.uint64
    sectors: int
    blocks: int
    length: float
    rim: NDArray[np.int64]
    near: int
    numbers: Numbers
    happened: NDArray[np.int64]


def sectors_of(grid: Grid, block: int) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """The part of each tile, and the places (parts, near) of the sites near each rim.

    Part k * 2^d + s is the sector s of the block k."""
    d, side = len(grid.size), block // 2
    r = np.moveaxis(np.indices(grid.tiles), 0, -1).reshape(-1, d) << np.array(BITS[d])
    blocks = [length // block for length in grid.size]
    home = np.zeros(len(r), np.int64)
    for k in range(d):
        home = home * blocks[k] + r[:, k] // block
    for k in range(d):
        home = home * 2 + r[:, k] % block // side
    within = np.indices((side,) * d).reshape(d, -1).T
    near = within[((within < REACH) | (within >= side - REACH)).any(axis=1)]
    first = np.zeros((int(home.max()) + 1, d), np.int64)
    order = np.argsort(-home, kind="stable")  # the first tile of a part comes last, and stays
    first[home[order][::-1]] = r[order][::-1]
    corners = first // side * side
    return home.astype(np.int32), places(grid, corners[:, None] + near[None])


@scalar
def _order(blocks, cycle, k, sectors):
    """The sector that is the k-th at work in a cycle: a random order (Fisher and Yates)."""
    order = U(0x76543210)  # a digit of 4 bits for each
    for m in range(sectors - 1):
        a, _, _, _ = words(Counter(blocks.seed, U(cycle)), SECTOR_ORDER, m, 0)
        other = m + np.int64((a * U(sectors - m)) >> U(32))
        change = ((order >> U(4 * m)) ^ (order >> U(4 * other))) & U(15)
        order ^= (change << U(4 * m)) | (change << U(4 * other))
    return np.int64((order >> U(4 * k)) & U(15))


@kernel
def cycles(worker, model, sites, choice, blocks, first, last):
    """The cycles from one to before another."""
    for cycle in range(first, last):
        for k in range(blocks.sectors):
            sector = _order(blocks, cycle, k, blocks.sectors)
            # blocks side by side, so that hardly any two threads write to one line of the cache
            begin = worker.thread * blocks.blocks // worker.threads
            end = (worker.thread + 1) * blocks.blocks // worker.threads
            for block in range(begin, end):
                part = block * blocks.sectors + sector
                _work(worker.thread, model, sites, choice, blocks, cycle, part)
            barrier(worker)


@scalar
def _work(thread, model, sites, choice, blocks, cycle, part):
    """Let a sector go on by a cycle of time."""
    # what its neighbours did since it was last at work has changed rates near its rim
    for k in range(blocks.near):
        settle_rim(model, sites, choice, part, blocks.rim[U(part * blocks.near + k)])
    none, total = sites.grid.neighbours, total_rate(choice, part)
    start, n, slot = U(cycle) << U(24), U(0), thread * AHEAD
    draw(blocks.numbers, blocks.seed, SECTOR_EVENT, start, part, slot)
    # a waiting time that crosses the end of the cycle is drawn anew: none is remembered
    time = blocks.numbers.waits[U(slot)] / total if total > 0.0 else np.inf
    row = thread * (len(blocks.happened) // (len(blocks.numbers.waits) // AHEAD))
    while time < blocks.length:
        at = U(slot) + (n & U(AHEAD - 1))
        units, streams = blocks.numbers.units, blocks.numbers.streams
        i, left = choose(choice, sites, part, total, units[at], streams[at])
        happens = chance(choice, known(model, sites, i))
        if left < happens:
            process, direction = happen(model, sites, choice, part, i, left / happens)
            column = direction if direction >= 0 else none
            blocks.happened[U(row + process * (none + 1) + column)] += 1
            total = total_rate(choice, part)
        n += U(1)
        if n & U(AHEAD - 1) == 0:
            draw(blocks.numbers, blocks.seed, SECTOR_EVENT, start + n, part, slot)
        wait = blocks.numbers.waits[U(slot) + (n & U(AHEAD - 1))]
        time += wait / total if total > 0.0 else np.inf
