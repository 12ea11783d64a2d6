"""Beads of solutes in the collision cells: one thread a bead, of which the first of a cell acts.

Which bead is the first is left to chance. The sums of a cell are floats, so beads are added up in
the order that the processor's engine has.
"""

from typing import Any, NamedTuple

from mesokit.loops.layout import record_length, sums_length
from mesokit.method.mpcd.engine.beads.coupling import answer_to, with_bead, without_beads
from mesokit.method.mpcd.engine.cpu.strips.terms import nothing_found
from mesokit.scalar.jit import scalar
from mesokit.scalar.pointer import put_reals, put_whole, reals, take_number, whole, words_at


class Meetings(NamedTuple):
    """Which beads are in each cell, by addresses of int32 numbers.

    cells: their number; one more has the beads whose places are no numbers, which do not collide.
    count (cells + 1,): how many are in each, start (cells + 1,): where they begin in `members`
    (beads,).
    rank (beads,): place of each among those of its cell. taken: so many places have been given.
    """

    cells: int
    count: Any
    start: int
    members: int
    rank: int
    taken: int


@scalar
def reserve_members(i, cell, met):
    """The first bead of a cell takes places for all in it."""
    if whole(met.rank, i) == 0:
        here = whole(cell, i)
        put_whole(met.start, here, take_number(met.taken, 0, whole(met.count, here)))


@scalar
def enter_members(i, cell, met):
    """Every bead takes its place."""
    put_whole(met.members, whole(met.start, whole(cell, i)) + whole(met.rank, i), i)


@scalar
def join_cell(i, physics, now, fluid, beads, met):
    """Coefficients for a cell with beads, from sums that `collide_cell` is about to clear."""
    cell = whole(beads.cell, i)
    if whole(met.rank, i) == 0 and cell < met.cells:
        first, number = whole(met.start, cell), whole(met.count, cell)
        sort_down(met.members, first, first + number)
        start = cell * sums_length(len(physics.terms))
        found = words_at(fluid.sums, start, nothing_found(physics.terms))
        total = without_beads(beads, physics, now.counter, cell, found)
        for n in range(first, first + number):
            total = with_bead(beads, whole(met.members, n), total, physics.zero)
        answer = answer_to(physics, now.counter, cell, total)
        put_reals(beads.answers, i * len(physics.coefficients), answer)


@scalar
def sort_down(members, first, last):
    """Bring the beads of a cell in the order of their numbers, the last one first."""
    # Insertion: there are few. Sums of floats are added up in this order, as on the CPU.
    for n in range(first + 1, last):
        one, place = whole(members, n), n
        while place > first and whole(members, place - 1) < one:
            put_whole(members, place, whole(members, place - 1))
            place -= 1
        put_whole(members, place, one)


@scalar
def answer_cell(i, physics, now, fluid, beads, met):
    """Replace the coefficients that `collide_cell` found without beads."""
    cell, needed = whole(beads.cell, i), physics.coefficients
    if whole(met.rank, i) == 0:
        put_whole(met.count, cell, 0)
        if cell < met.cells:
            answer = reals(beads.answers, i * len(needed), needed)
            put_reals(fluid.coefficients, cell * record_length(len(needed)), answer)
