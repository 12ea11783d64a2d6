"""Beads of solutes on ranks: the owner of each bead, and the copies in the halos of other ranks.

The owner of a bead is the rank in whose block it is when a step begins; it moves the bead. Ranks
whose blocks are near receive its place at every sub-step, since it acts on their beads. Arrays of
beads have the same length on every rank; only own beads and copies are up to date there.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.case.box import fold
from mesokit.kernels.part import stage
from mesokit.loops.neighbours import insert
from mesokit.loops.threads import barrier
from mesokit.method.mpcd.engine.beads.neighbours import MADE
from mesokit.method.mpcd.engine.beads.state import AROUND, OWN, has_halo, load_place, load_velocity
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, in_block, moved_grid
from mesokit.method.mpcd.engine.cpu.strips.rows import store_values
from mesokit.method.mpcd.engine.domains.messages.ghosts import NO_OWNER, owner_of
from mesokit.method.mpcd.engine.domains.messages.mpi import Post, finish, receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import (
    BEAD_WORDS,
    FAULTS,
    MESSAGES,
    STRETCHED,
    address_of,
)
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import scaled

NUMBERS, PLACES = 5, 6  # tags of messages


class Halo(NamedTuple):
    """Own beads of a rank, and copies of beads near its block; q partners, B beads.

    ranks (q,): the partners. count (3,), numbers (3, B): ids of own beads, of own beads and copies,
    and of beads in own cells, whichever rank moves them; see `state.OWN`.
    seen (B,): last step in which each was an own bead or a copy; began (B * d,): places of own
    beads at the start of the step.
    reach: distance from a block within which beads act on those in it; most: square of the longest
    path in a step.
    copies_out, copies_in (q,), ids_out, ids_in (q, B): copies sent to each partner and received.
    remote (q,), remote_ids, remote_cells (q, B): own beads in cells of partners, and the numbers of
    these cells there.
    out, into (q, 1 + B, 1 + 2 d); terms_out, terms_in (q, 1 + B, 2 + terms): messages.
    slot: first record of coefficients of own beads in cells of partners.
    """

    post: Post
    ranks: Any
    count: Any
    numbers: Any
    seen: Any
    began: Any
    reach: float
    most: float
    copies_out: Any
    copies_in: Any
    ids_out: Any
    ids_in: Any
    remote: Any
    remote_ids: Any
    remote_cells: Any
    out: Any
    into: Any
    terms_out: Any
    terms_in: Any
    slot: int
    slides: float  # 1.0 if images along y slide
    wraps: tuple  # 1.0 for each axis along which the box repeats


@where(beads=has_halo)
@stage
def assign_beads(worker, now, physics, box, fluid, beads):
    """At the start of a step: migrate beads to their owners, and exchange copies near blocks."""
    barrier(worker)
    if worker.thread == 0:
        changed = migrate_beads(now, physics, box, fluid.cells.shared, beads)
        changed |= exchange_copies(now, physics, box, fluid.cells.shared, beads)
        if changed:
            forget_lists(beads.neighbours)
        check_copies(now, fluid.cells.shared, beads)
    barrier(worker)


@where(neighbours=len)
def forget_lists(neighbours):
    """Mark neighbour lists as outdated: other beads are around the block now."""
    (lists,) = neighbours
    for t in range(len(lists.noted)):
        lists.noted[t, MADE] = 0.0


@scalar
def migrate_beads(now, physics, box, shared, beads):
    """Migrate beads to the ranks in whose blocks they are; true if any came or went."""
    halo, zero, kept = beads.halo, physics.zero, 0
    grid = moved_grid(now.grid, scaled(0.0, zero), shared.closed)
    for p in range(len(halo.ranks)):
        halo.out[p, 0, 0] = 0.0
    number = halo.count[OWN]
    # Sort own beads into those that stay and those for partners, by cells without a shift: all
    # ranks find the same owner. Beads that stay move up in the list, so ids remain in order.
    for n in range(number):
        i = halo.numbers[OWN, n]
        mine, v = load_place(beads, i, zero), load_velocity(beads, i, zero)
        r, _, _ = fold(box, mine, v, scaled(0.0, zero))
        place = cell_in_box(r, grid)
        owner, _ = owner_of(shared, place)
        owner = NO_OWNER if in_block(shared.limits, place) else owner  # no partner, or this rank
        if owner == NO_OWNER:
            halo.numbers[OWN, kept] = i
            kept += 1
        else:
            append(halo.out, owner, i, mine, v)
    gone = number - kept
    exchange_bead_rows(halo, shared, NUMBERS)
    # Beads that arrive are inserted by id. The order of own beads is then the same whichever
    # partner sent them.
    for p in range(len(halo.ranks)):
        for row in range(1, 1 + int(halo.into[p, 0, 0])):
            i = read_place(halo.into, p, row, beads, zero)
            for k in range(len(zero)):
                beads.v[i * len(zero) + k] = halo.into[p, row, 1 + len(zero) + k]
            kept = insert(halo.numbers, OWN, kept, i)
            gone += 1
    halo.count[OWN] = kept
    # Places at t, from which `find_bead_owners` measures the path of the step.
    for n in range(kept):
        i = halo.numbers[OWN, n]
        store_values(halo.began, np.uint64(i * len(zero)), load_place(beads, i, zero))
    return gone != 0


@scalar
def append(out, p, i, r, v):
    """Add id, place and velocity of a bead to the message to a partner."""
    row, d = 1 + int(out[p, 0, 0]), len(r)
    out[p, row, 0] = float(i)
    for k in range(d):
        out[p, row, 1 + k], out[p, row, 1 + d + k] = r[k], v[k]
    out[p, 0, 0] = float(row)


@scalar
def read_place(rows, p, row, beads, zero):
    """Set the place of a bead from a row of a message; returns its id."""
    i = int(rows[p, row, 0])
    for k in range(len(zero)):
        beads.r[i * len(zero) + k] = rows[p, row, 1 + k]
    return i


@scalar
def exchange_bead_rows(halo, shared, tag):
    """Send whole rows to all partners, and receive theirs."""
    post, n, words = halo.post, 0, halo.out.shape[2]
    most = halo.out.shape[1] * words
    for p in range(len(halo.ranks)):
        n = receive(post, n, address_of(halo.into, p), most, halo.ranks[p], tag)
    for p in range(len(halo.ranks)):
        sent = (1 + int(halo.out[p, 0, 0])) * words
        n = send(post, n, address_of(halo.out, p), sent, halo.ranks[p], tag)
        shared.meter[MESSAGES] += 1
        shared.meter[BEAD_WORDS] += sent
    finish(post, n)


@scalar
def exchange_copies(now, physics, box, shared, beads):
    """Exchange copies of beads near blocks; true if a copy is here that was not one step before."""
    halo, zero, step = beads.halo, physics.zero, np.int64(now.counter.step)
    number, new = halo.count[OWN], False
    for p in range(len(halo.ranks)):
        halo.out[p, 0, 0], halo.copies_out[p] = 0.0, 0
    # A bead may be near several partners. Its place is sent in its own image, so bonds remain plain
    # differences there. `ids_out` keeps the order of the rows for the places of all sub-steps.
    for n in range(number):
        i = halo.numbers[OWN, n]
        halo.numbers[AROUND, n] = i
        mine, v = load_place(beads, i, zero), load_velocity(beads, i, zero)
        r, _, _ = fold(box, mine, v, scaled(0.0, zero))
        for p in range(len(halo.ranks)):
            if near_block(halo, shared, p, r):
                append(halo.out, p, i, mine, v)
                halo.ids_out[p, halo.copies_out[p]] = i
                halo.copies_out[p] += 1
        halo.seen[i] = step
    exchange_bead_rows(halo, shared, NUMBERS)
    # Copies follow own beads in the list. A bead that was not here in the last step is on no
    # neighbour list yet, so lists must be made anew.
    for p in range(len(halo.ranks)):
        halo.copies_in[p] = int(halo.into[p, 0, 0])
        for row in range(1, 1 + halo.copies_in[p]):
            i = read_place(halo.into, p, row, beads, zero)
            halo.ids_in[p, row - 1] = i
            halo.numbers[AROUND, number] = i
            new |= halo.seen[i] != step - 1
            halo.seen[i] = step
            number += 1
    halo.count[AROUND] = number
    return new


@scalar
def near_block(halo, shared, p, r):
    """Whether a bead at a place in the box acts on beads in the block of a partner."""
    near, across = True, False
    # A bead is near if its distance from the block is within reach along every axis, directly or
    # across an end of the box. The order is z, y, x: images beyond an end along y may have any x
    # under shear, so x does not count then.
    for j in range(len(r)):
        k = len(r) - 1 - j
        low, high = float(shared.blocks[p, 0, k]), float(shared.blocks[p, 1, k])
        whole = float(shared.cells[k])
        away = max(low - r[k], r[k] - high, 0.0)
        if halo.wraps[k] > 0.5:
            x, y = r[k] - whole, r[k] + whole
            other = min(max(low - x, x - high, 0.0), max(low - y, y - high, 0.0))
            if k == 1 and halo.slides > 0.5 and other <= halo.reach:
                across = True
            away = min(away, other)
        near &= (away <= halo.reach) | (across & (k == 0))
    return near


@scalar
def check_copies(now, shared, beads):
    """Note a fault if an own bead has a bond or an angle with a bead that has no copy here."""
    halo, step = beads.halo, np.int64(now.counter.step)
    # Copies reach as far as nearly all bonds are long. A longer bond would act on an old place, so
    # the run stops instead.
    for n in range(halo.count[OWN]):
        i = halo.numbers[OWN, n]
        for m in range(beads.bond_starts[i], beads.bond_starts[i + 1]):
            if halo.seen[beads.bonds[m]] != step:
                shared.noted[FAULTS] |= STRETCHED
        for m in range(beads.angle_starts[i], beads.angle_starts[i + 1]):
            for role in range(3):
                if halo.seen[beads.angles[m, role]] != step:
                    shared.noted[FAULTS] |= STRETCHED


@where(beads=has_halo)
@stage
def update_copies(worker, beads):
    """Send places of own beads to the ranks that keep copies, and receive those of copies."""
    if worker.thread == 0:
        halo = beads.halo
        post, n, d = halo.post, 0, len(beads.r) // len(beads.cell)
        # The lists of copies are fixed for the step, so messages have places only, without ids.
        # Receives are posted before sends. The floats are sent unchanged: forces on own beads
        # have the same bits as on one rank.
        for p in range(len(halo.ranks)):
            if halo.copies_in[p] > 0:
                words = halo.copies_in[p] * d
                n = receive(post, n, address_of(halo.into, p), words, halo.ranks[p], PLACES)
        for p in range(len(halo.ranks)):
            if halo.copies_out[p] > 0:
                rows = halo.out[p].reshape(-1)
                for j in range(halo.copies_out[p]):
                    for k in range(d):
                        rows[j * d + k] = beads.r[halo.ids_out[p, j] * d + k]
                words = halo.copies_out[p] * d
                n = send(post, n, address_of(halo.out, p), words, halo.ranks[p], PLACES)
        finish(post, n)
        for p in range(len(halo.ranks)):
            rows = halo.into[p].reshape(-1)
            for j in range(halo.copies_in[p]):
                for k in range(d):
                    beads.r[halo.ids_in[p, j] * d + k] = rows[j * d + k]
    barrier(worker)
