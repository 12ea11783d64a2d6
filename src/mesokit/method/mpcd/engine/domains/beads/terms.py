"""What beads of solutes add to cells of other ranks, which hear of it and answer."""

from typing import Any

import numpy as np

from mesokit.method.mpcd.engine.beads.state import OWN, PRESENT, load_folded, load_place
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, in_block
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values
from mesokit.method.mpcd.engine.domains.beads.roster import insert
from mesokit.method.mpcd.engine.domains.messages.guests import NOBODY, owner_of
from mesokit.method.mpcd.engine.domains.messages.mpi import receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import (
    BEAD_WORDS,
    FAR,
    FAULTS,
    MESSAGES,
    STRETCHED,
)
from mesokit.scalar.jit import by_type
from mesokit.scalar.vector import added_scaled, dot

TERMS = 7  # tag of messages


@by_type
def find_bead_owners(team, now, physics, fluid, beads):
    """Which own beads are in own cells and in those of others: how many ask each partner."""
    if not has_roster(beads):
        return lambda team, now, physics, fluid, beads: None
    return _find_owners


def has_roster(beads: Any) -> bool:
    """Whether beads are shared, from the numba type of `Beads` or of ()."""
    return len(beads) > 0 and len(beads.types[beads.fields.index("roster")]) > 0


def _find_owners(team, now, physics, fluid, beads):
    if team.thread == 0:
        roster, shared, present, zero = beads.roster, fluid.cells.shared, 0, physics.zero
        for p in range(len(roster.ranks)):
            roster.asked[p] = 0
        for n in range(roster.count[OWN]):
            i = roster.who[OWN, n]
            moved = added_scaled(
                load_place(beads, i, zero),
                -1.0,
                load_values(roster.began, np.uint64(i * len(zero)), zero),
            )
            if dot(moved, moved) > roster.most:
                shared.noted[FAULTS] |= STRETCHED
            r, _, _ = load_folded(beads, i, now.box, now.grid.shift)
            place = cell_in_box(r, now.grid)
            if in_block(shared.limits, place):
                roster.who[PRESENT, present] = i
                present += 1
            else:
                p, cell = owner_of(shared, place)
                if p == NOBODY:
                    shared.noted[FAULTS] |= FAR
                else:
                    roster.ask[p, roster.asked[p]], roster.cell[p, roster.asked[p]] = i, cell
                    roster.asked[p] += 1
                    beads.cell[i] = roster.slot + n
        roster.count[PRESENT] = present


@by_type
def beads_that_ask(team, beads, p):
    """How many beads of this rank are in cells of a partner; the first thread alone writes them."""
    if not has_roster(beads):
        return lambda team, beads, p: 0
    return lambda team, beads, p: beads.roster.asked[p] if team.thread == 0 else 0


@by_type
def bead_row(beads, p, j):
    """The slot and the cell there of the jth of them."""
    if not has_roster(beads):
        return lambda beads, p, j: (np.int64(0), np.int64(0))
    return lambda beads, p, j: (
        np.int64(beads.cell[beads.roster.ask[p, j]]),
        beads.roster.cell[p, j],
    )


@by_type
def send_terms(beads, shared, n):
    """What beads add to cells of partners, on its way; messages in hand."""
    return _send_terms if has_roster(beads) else lambda beads, shared, n: n


def _send_terms(beads, shared, n):
    roster = beads.roster
    terms, words = len(beads.terms), roster.terms_out.shape[2]
    most = roster.terms_out.shape[1] * words
    size = np.uint64(8 * most)
    for p in range(len(roster.ranks)):
        at = np.uint64(roster.terms_in.ctypes.data) + np.uint64(p) * size
        n = receive(shared.post, n, at, most, roster.ranks[p], TERMS)
    for p in range(len(roster.ranks)):
        roster.terms_out[p, 0, 0] = float(roster.asked[p])
        for j in range(roster.asked[p]):
            i = roster.ask[p, j]
            roster.terms_out[p, 1 + j, 0] = float(i)
            roster.terms_out[p, 1 + j, 1] = float(roster.cell[p, j])
            for k in range(terms):
                roster.terms_out[p, 1 + j, 2 + k] = beads.given[i * terms + k]
        at = np.uint64(roster.terms_out.ctypes.data) + np.uint64(p) * size
        sent = (1 + roster.asked[p]) * words
        n = send(shared.post, n, at, sent, roster.ranks[p], TERMS)
        shared.meter[MESSAGES] += 1
        shared.meter[BEAD_WORDS] += sent
    return n


@by_type
def take_terms(beads):
    """What beads of others add to cells of this rank."""
    return _take_terms if has_roster(beads) else lambda beads: None


def _take_terms(beads):
    roster, terms = beads.roster, len(beads.terms)
    present = roster.count[PRESENT]
    for p in range(len(roster.ranks)):
        for row in range(1, 1 + int(roster.terms_in[p, 0, 0])):
            i = int(roster.terms_in[p, row, 0])
            beads.cell[i] = np.int32(roster.terms_in[p, row, 1])
            for k in range(terms):
                beads.given[i * terms + k] = roster.terms_in[p, row, 2 + k]
            present = insert(roster.who, PRESENT, present, i)
    roster.count[PRESENT] = present


@by_type
def joint_answer(beads, cell, answer):
    """The answer for a cell: that of its fluid, or of fluid and beads together."""
    return _joint if has_roster(beads) else lambda beads, cell, answer: answer


def _joint(beads, cell, answer):
    leader = beads.head[cell]
    if leader >= 0:
        return load_values(beads.answers, np.uint64(leader * len(answer)), answer)
    return answer
