"""Remote beads: own beads in cells of partners.

Their terms are sent to the owner of the cell, which adds them to its sums and returns the
coefficients of the collision.
"""

import numpy as np

from mesokit.method.mpcd.engine.beads.state import OWN, PRESENT, has_halo, load_folded, load_place
from mesokit.method.mpcd.engine.cpu.grid import cell_in_box, in_block
from mesokit.method.mpcd.engine.cpu.strips.rows import load_values
from mesokit.method.mpcd.engine.domains.beads.halo import insert
from mesokit.method.mpcd.engine.domains.messages.ghosts import NO_OWNER, owner_of
from mesokit.method.mpcd.engine.domains.messages.mpi import receive, send
from mesokit.method.mpcd.engine.domains.messages.shared import (
    BEAD_WORDS,
    FAR,
    FAULTS,
    MESSAGES,
    STRETCHED,
    address_of,
)
from mesokit.method.mpcd.engine.where import where
from mesokit.scalar.vector import added_scaled, dot

TERMS = 7  # tag of messages


@where(beads=has_halo)
def find_bead_owners(worker, now, physics, fluid, beads):
    """Find the cells of own beads: those in own cells, and remote beads of each partner."""
    if worker.thread == 0:
        halo, shared, present, zero = beads.halo, fluid.cells.shared, 0, physics.zero
        for p in range(len(halo.ranks)):
            halo.remote[p] = 0
        # Places are those at t + dt, in the cells of the shifted grid. A remote bead gets a record
        # of its own behind the cells of the halo, to which its coefficients return. One thread
        # does all of it: beads are few.
        for n in range(halo.count[OWN]):
            i = halo.numbers[OWN, n]
            began = load_values(halo.began, np.uint64(i * len(zero)), zero)
            moved = added_scaled(load_place(beads, i, zero), -1.0, began)
            if dot(moved, moved) > halo.most:
                shared.noted[FAULTS] |= STRETCHED
            r, _, _ = load_folded(beads, i, now.box, now.grid.shift)
            place = cell_in_box(r, now.grid)
            if in_block(shared.limits, place):
                halo.numbers[PRESENT, present] = i
                present += 1
            else:
                p, cell = owner_of(shared, place)
                if p == NO_OWNER:
                    shared.noted[FAULTS] |= FAR
                else:
                    row = halo.remote[p]
                    halo.remote_ids[p, row], halo.remote_cells[p, row] = i, cell
                    halo.remote[p] = row + 1
                    beads.cell[i] = halo.slot + n
        halo.count[PRESENT] = present


@where("0", beads=has_halo)
def remote_beads(worker, beads, p):
    """Number of remote beads in cells of a partner; only the first thread writes their rows."""
    return beads.halo.remote[p] if worker.thread == 0 else 0


@where("(np.int64(0), np.int64(0))", beads=has_halo)
def bead_row(beads, p, j):
    """The record and the cell there of the jth remote bead of a partner."""
    return np.int64(beads.cell[beads.halo.remote_ids[p, j]]), beads.halo.remote_cells[p, j]


@where("n", beads=has_halo)
def send_terms(beads, shared, n):
    """Begin to exchange the terms of remote beads; returns the number of open messages."""
    halo = beads.halo
    terms, words = len(beads.terms), halo.terms_out.shape[2]
    most = halo.terms_out.shape[1] * words
    for p in range(len(halo.ranks)):
        n = receive(shared.post, n, address_of(halo.terms_in, p), most, halo.ranks[p], TERMS)
    # Floats as they are, with the id and the number of the cell at its owner. The owner adds them
    # by id, so the sums of a cell have the same bits as on one rank.
    for p in range(len(halo.ranks)):
        halo.terms_out[p, 0, 0] = float(halo.remote[p])
        for j in range(halo.remote[p]):
            i = halo.remote_ids[p, j]
            halo.terms_out[p, 1 + j, 0] = float(i)
            halo.terms_out[p, 1 + j, 1] = float(halo.remote_cells[p, j])
            for k in range(terms):
                halo.terms_out[p, 1 + j, 2 + k] = beads.given[i * terms + k]
        sent = (1 + halo.remote[p]) * words
        n = send(shared.post, n, address_of(halo.terms_out, p), sent, halo.ranks[p], TERMS)
        shared.meter[MESSAGES] += 1
        shared.meter[BEAD_WORDS] += sent
    return n


@where(beads=has_halo)
def take_terms(beads):
    """Store the terms of remote beads of partners, which lie in own cells."""
    halo, terms = beads.halo, len(beads.terms)
    present = halo.count[PRESENT]
    # Inserted by id: a cell adds up its beads in one order, from whichever rank they come.
    for p in range(len(halo.ranks)):
        for row in range(1, 1 + int(halo.terms_in[p, 0, 0])):
            i = int(halo.terms_in[p, row, 0])
            beads.cell[i] = np.int32(halo.terms_in[p, row, 1])
            for k in range(terms):
                beads.given[i * terms + k] = halo.terms_in[p, row, 2 + k]
            present = insert(halo.numbers, PRESENT, present, i)
    halo.count[PRESENT] = present


@where("answer", beads=has_halo)
def joint_answer(beads, cell, answer):
    """The coefficients of a cell: of its fluid, or of fluid and beads together."""
    leader = beads.head[cell]
    if leader >= 0:
        return load_values(beads.answers, np.uint64(leader * len(answer)), answer)
    return answer
