"""Beads of solutes on ranks: whose they are, and which others each must hear of.

A bead is moved by the rank in whose block it is when a step begins. Ranks whose blocks are near
hear where it is at every sub-step, since their beads may feel it. Arrays of beads are as long on
every rank; only places of beads around its block are kept up to date there.
"""

from typing import Any, NamedTuple

import numpy as np

from mesokit.case.box import fold
from mesokit.kernels.part import stage
from mesokit.loops.threads import meet
from mesokit.method.mpcd.engine.beads.neighbours import MADE
from mesokit.method.mpcd.engine.beads.state import (
    AROUND,
    OWN,
    load_place,
    load_velocity,
)
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, in_block, moved_grid
from mesokit.method.mpcd.engine.cpu.strips.rows import store_values
from mesokit.method.mpcd.engine.domains.messages.guests import NOBODY, owner_of
from mesokit.method.mpcd.engine.domains.messages.mpi import Post, finish, receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import (
    BEAD_WORDS,
    FAULTS,
    MESSAGES,
    STRETCHED,
)
from mesokit.scalar.jit import by_type, scalar
from mesokit.scalar.vector import scaled

ROLL, PLACES = 5, 6  # tags of messages


class Roster(NamedTuple):
    """Who is where; q partners, B beads.

    ranks (q,): the partners. count (3,), who (3, B): numbers of own beads, of these and those that
    are heard of, of those in own cells, whoever moves them; see `state.OWN`.
    seen (B,): step at which each was last around; began (B * d,): where own beads were when it did.
    reach: how far from a block beads matter there; most: square of the longest way in a step.
    told, heard (q,), tell, hear (q, B): which beads the partners are told of, and tell of.
    asked (q,), ask, cell (q, B): own beads in cells of partners, and their cells there.
    out, into (q, 1 + B, 1 + 2 d); terms_out, terms_in (q, 1 + B, 2 + terms): messages.
    slot: where the answers for those in cells of others begin.
    """

    post: Post
    ranks: Any
    count: Any
    who: Any
    seen: Any
    began: Any
    reach: float
    most: float
    told: Any
    heard: Any
    tell: Any
    hear: Any
    asked: Any
    ask: Any
    cell: Any
    out: Any
    into: Any
    terms_out: Any
    terms_in: Any
    slot: int
    slides: float  # 1.0 if images along y slide
    wraps: tuple  # 1.0 for each axis along which the box repeats


@by_type
def call_roll(team, now, physics, box, fluid, beads):
    """At the begin of a step: beads go to whose block they are in, and all hear of those near."""
    if len(beads.types[beads.fields.index("roster")]) == 0:
        return lambda team, now, physics, box, fluid, beads: None
    return lambda team, now, physics, box, fluid, beads: _call(
        team, now, physics, box, fluid, beads
    )


@stage
def _call(team, now, physics, box, fluid, beads):
    meet(team)
    if team.thread == 0:
        changed = hand_over(now, physics, box, fluid.cells.shared, beads)
        changed |= hear_of_others(now, physics, box, fluid.cells.shared, beads)
        if changed:
            forget_lists(beads.neighbours)
        require_partners(now, fluid.cells.shared, beads)
    meet(team)


@by_type
def forget_lists(neighbours):
    """Lists of neighbours are made anew: there are others around."""
    return _forget if len(neighbours) else lambda neighbours: None


def _forget(neighbours):
    (lists,) = neighbours
    for t in range(len(lists.noted)):
        lists.noted[t, MADE] = 0.0


@scalar
def hand_over(now, physics, box, shared, beads):
    """Beads in blocks of others go there; whether any came or went."""
    roster, zero, kept = beads.roster, physics.zero, 0
    grid = moved_grid(now.grid, scaled(0.0, zero), shared.closed)
    for p in range(len(roster.ranks)):
        roster.out[p, 0, 0] = 0.0
    number = roster.count[OWN]
    for n in range(number):
        i = roster.who[OWN, n]
        r, _, _ = fold(
            box, load_place(beads, i, zero), load_velocity(beads, i, zero), zero_of(zero)
        )
        owner = owner_or_own(shared, cell_in_box(r, grid))
        if owner == NOBODY:
            roster.who[OWN, kept] = i
            kept += 1
        else:
            append(roster.out, owner, i, load_place(beads, i, zero), load_velocity(beads, i, zero))
    gone = number - kept
    exchange(roster, shared, ROLL)
    for p in range(len(roster.ranks)):
        for row in range(1, 1 + int(roster.into[p, 0, 0])):
            i = take_place(roster.into, p, row, beads, zero)
            put_velocity(roster.into, p, row, beads, i, zero)
            kept = insert(roster.who, OWN, kept, i)
            gone += 1
    roster.count[OWN] = kept
    for n in range(kept):
        i = roster.who[OWN, n]
        store_values(roster.began, np.uint64(i * len(zero)), load_place(beads, i, zero))
    return gone != 0


@scalar
def zero_of(like):
    """The zero vector."""
    return scaled(0.0, like)


@scalar
def owner_or_own(shared, place):
    """The partner whose cell that is; NOBODY if it is this rank's own, or nobody's in reach."""
    owner, _ = owner_of(shared, place)
    return NOBODY if in_block(shared.limits, place) else owner


@scalar
def insert(who, which, number, i):
    """Put a number into an ordered list; how many there are then."""
    place = number
    while place > 0 and who[which, place - 1] > i:
        who[which, place] = who[which, place - 1]
        place -= 1
    who[which, place] = i
    return number + 1


@scalar
def append(out, p, i, r, v):
    """Add a row to the message to a partner."""
    row, d = 1 + int(out[p, 0, 0]), len(r)
    out[p, row, 0] = float(i)
    for k in range(d):
        out[p, row, 1 + k], out[p, row, 1 + d + k] = r[k], v[k]
    out[p, 0, 0] = float(row)


@scalar
def take_place(rows, p, row, beads, zero):
    """Put a bead where a message says; its number."""
    i = int(rows[p, row, 0])
    for k in range(len(zero)):
        beads.r[i * len(zero) + k] = rows[p, row, 1 + k]
    return i


@scalar
def put_velocity(rows, p, row, beads, i, zero):
    """The same for its velocity."""
    d = len(zero)
    for k in range(d):
        beads.v[i * d + k] = rows[p, row, 1 + d + k]


@scalar
def exchange(roster, shared, tag):
    """Messages of whole rows to all partners, and from them."""
    post, n, words = roster.post, 0, roster.out.shape[2]
    most = roster.out.shape[1] * words
    size = np.uint64(8 * most)
    for p in range(len(roster.ranks)):
        at = np.uint64(roster.into.ctypes.data) + np.uint64(p) * size
        n = receive(post, n, at, most, roster.ranks[p], tag)
    for p in range(len(roster.ranks)):
        at = np.uint64(roster.out.ctypes.data) + np.uint64(p) * size
        sent = (1 + int(roster.out[p, 0, 0])) * words
        n = send(post, n, at, sent, roster.ranks[p], tag)
        shared.meter[MESSAGES] += 1
        shared.meter[BEAD_WORDS] += sent
    finish(post, n)


@scalar
def hear_of_others(now, physics, box, shared, beads):
    """Tell all of beads near their blocks, hear of theirs; whether somebody is new here."""
    roster, zero, step = beads.roster, physics.zero, np.int64(now.counter.step)
    number, new = roster.count[OWN], False
    for p in range(len(roster.ranks)):
        roster.out[p, 0, 0], roster.told[p] = 0.0, 0
    for n in range(number):
        i = roster.who[OWN, n]
        roster.who[AROUND, n] = i
        mine, v = load_place(beads, i, zero), load_velocity(beads, i, zero)
        r, _, _ = fold(box, mine, v, zero_of(zero))
        for p in range(len(roster.ranks)):
            if near_block(roster, shared, p, r):
                append(roster.out, p, i, mine, v)
                roster.tell[p, roster.told[p]] = i
                roster.told[p] += 1
        roster.seen[i] = step
    exchange(roster, shared, ROLL)
    for p in range(len(roster.ranks)):
        roster.heard[p] = int(roster.into[p, 0, 0])
        for row in range(1, 1 + roster.heard[p]):
            i = take_place(roster.into, p, row, beads, zero)
            roster.hear[p, row - 1] = i
            roster.who[AROUND, number] = i
            new |= roster.seen[i] != step - 1
            roster.seen[i] = step
            number += 1
    roster.count[AROUND] = number
    return new


@scalar
def near_block(roster, shared, p, r):
    """Whether a place in the box is so near to the block of a partner that beads there matter."""
    near, across = True, False
    for j in range(len(r)):
        k = len(r) - 1 - j  # z, y, x: images beyond an end along y may have any x
        low, high = float(shared.blocks[p, 0, k]), float(shared.blocks[p, 1, k])
        whole = float(shared.cells[k])
        away = max(low - r[k], r[k] - high, 0.0)
        if roster.wraps[k] > 0.5:
            x, y = r[k] - whole, r[k] + whole
            other = min(max(low - x, x - high, 0.0), max(low - y, y - high, 0.0))
            if k == 1 and roster.slides > 0.5 and other <= roster.reach:
                across = True
            away = min(away, other)
        near &= (away <= roster.reach) | (across & (k == 0))
    return near


@scalar
def require_partners(now, shared, beads):
    """Note a fault if a bead is bonded to one that nobody told of."""
    roster, step = beads.roster, np.int64(now.counter.step)
    for n in range(roster.count[OWN]):
        i = roster.who[OWN, n]
        for m in range(beads.bond_starts[i], beads.bond_starts[i + 1]):
            if roster.seen[beads.bonds[m]] != step:
                shared.noted[FAULTS] |= STRETCHED
        for m in range(beads.angle_starts[i], beads.angle_starts[i + 1]):
            for role in range(3):
                if roster.seen[beads.angles[m, role]] != step:
                    shared.noted[FAULTS] |= STRETCHED


@by_type
def tell_places(team, beads):
    """Where beads are now, to all that must know."""
    if len(beads.types[beads.fields.index("roster")]) == 0:
        return lambda team, beads: None
    return lambda team, beads: _tell(team, beads)


@stage
def _tell(team, beads):
    if team.thread == 0:
        roster = beads.roster
        post, n, d = roster.post, 0, len(beads.r) // len(beads.cell)
        size = np.uint64(8 * roster.out.shape[1] * roster.out.shape[2])
        for p in range(len(roster.ranks)):
            if roster.heard[p] > 0:
                at = np.uint64(roster.into.ctypes.data) + np.uint64(p) * size
                n = receive(post, n, at, roster.heard[p] * d, roster.ranks[p], PLACES)
        for p in range(len(roster.ranks)):
            if roster.told[p] > 0:
                rows = roster.out[p].reshape(-1)
                for j in range(roster.told[p]):
                    for k in range(d):
                        rows[j * d + k] = beads.r[roster.tell[p, j] * d + k]
                at = np.uint64(roster.out.ctypes.data) + np.uint64(p) * size
                n = send(post, n, at, roster.told[p] * d, roster.ranks[p], PLACES)
        finish(post, n)
        for p in range(len(roster.ranks)):
            rows = roster.into[p].reshape(-1)
            for j in range(roster.heard[p]):
                for k in range(d):
                    beads.r[roster.hear[p, j] * d + k] = rows[j * d + k]
    meet(team)
