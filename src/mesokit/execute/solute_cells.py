"""Cells that hold beads: what their particles and beads need together in order to collide.

Cells add up the fluid alone, which then pays nothing for beads. For the few cells with beads the
sums are completed here, each by the thread whose share of `solve` it is in, and what follows from
them takes the place of the answer that `solve` finds for the fluid alone.
"""

import math

import numpy as np

from mesokit.execute.cache import inner
from mesokit.execute.cell_energy import asks
from mesokit.execute.cells import draw_with_care
from mesokit.execute.layout import LANES, record_length, share, sums_length
from mesokit.execute.rows import fetch, put
from mesokit.execute.solutes import FIRST_NUMBER
from mesokit.execute.sums import nothing_found, read_sums
from mesokit.gamma import gamma_number
from mesokit.mpcd.collision.protocol import coefficients as coefficients_of
from mesokit.mpcd.collision.protocol import contribute, freedom
from mesokit.mpcd.thermostat.protocol import guess
from mesokit.poisson import poisson_number
from mesokit.random import BODY_NUMBER, CELL, CELL_VIRTUAL, normals, words
from mesokit.scalar import added, by_type, dot, scalar, scaled

NOBODY = -1


@by_type
def join_solutes(solutes, *rest):
    """Answers for the cells with beads, from sums that `solve` is about to clear."""
    return _join if len(solutes) else lambda *_: None


@scalar
def cells_of_thread(thread, threads, number):
    """First and last + 1 of the cells that `solve` leaves to a thread."""
    first, last = share((number + LANES - 1) // LANES, thread, threads)
    return first * LANES, min(last * LANES, number)


def _join(solutes, thread, threads, physics, counter, sums, number, like, c, terms, scales):
    complete(solutes, thread, threads, physics, counter, sums, number, like, c, terms, scales)


@inner
def complete(solutes, thread, threads, physics, counter, sums, number, like, c, terms, scales):
    first, last = cells_of_thread(thread, threads, number)
    for i in range(len(solutes.cell)):
        cell = solutes.cell[i]
        if first <= cell < last:
            solutes.following[i] = solutes.head[cell]
            solutes.head[cell] = i
    for i in range(len(solutes.cell)):
        cell = solutes.cell[i]
        if first <= cell < last:
            solutes.leads[i] = solutes.head[cell] == i
            if solutes.leads[i]:
                answer = answer_for(solutes, i, physics, counter, sums, cell, like, terms, scales)
                put(solutes.answers, np.uint64(i * len(c)), answer)
    for i in range(len(solutes.cell)):
        cell = solutes.cell[i]
        if first <= cell < last:
            solutes.head[cell] = NOBODY


@scalar
def answer_for(solutes, leader, physics, counter, sums, cell, like, terms, scales):
    """What all in the cell of that bead, the first of its list, need to collide."""
    found = nothing_found(terms)
    for t in range(sums.shape[0]):
        start = np.uint64(cell) * np.uint64(sums_length(len(terms)))
        found = added(found, fetch(sums[t], start, found))
    n, mass, momentum, energy, own = read_sums(physics.masses, physics.energy, found, like, scales)
    mass = mass if n > 0.5 else 0.0
    n, mass, momentum, energy, own = with_random_solvent(
        solutes.solvent, solutes, physics, counter, cell, n, mass, momentum, energy, own, like
    )
    i = leader
    while i != NOBODY:
        more, its_energy, its_own = parts_of(
            fetch(solutes.given, np.uint64(i * len(solutes.terms)), solutes.terms), like
        )
        n, mass, momentum = n + 1.0, mass + solutes.mass, added(momentum, more)
        energy, own = energy + its_energy, added(own, its_own)
        i = solutes.following[i]
    chance = words(counter, CELL, cell, 0)
    x, sure = guess(physics.thermostat, chance[2:], freedom(physics.rule, n))
    if not sure:
        x = draw_with_care(physics, counter, cell, freedom(physics.rule, n))
    return coefficients_of(
        physics.rule, physics.thermostat, x, chance[:2], n, mass, momentum, energy, own
    )


@by_type
def parts_of(given, like):
    """Momentum, m v^2 and the rule's own sums of a bead."""
    d, rest = len(like), len(like) + 1
    return lambda given, like: (given[:d], given[d], given[rest:])


@by_type
def with_random_solvent(solvent, *rest):
    """The sums with as many particles as a cell holds, whose momentum is drawn from a Maxwellian;
    nothing where there is a fluid."""
    return _with_random_solvent if len(solvent) else _as_they_are


def _as_they_are(solvent, solutes, physics, counter, cell, n, mass, momentum, energy, own, like):
    return n, mass, momentum, energy, own


def _with_random_solvent(
    solvent, solutes, physics, counter, cell, n, mass, momentum, energy, own, like
):
    d, number = len(like), poisson_number(solvent[0], counter, BODY_NUMBER, cell)
    if number > 0:
        m = number * solvent[1]
        a, b, e, f = words(counter, CELL_VIRTUAL, cell, 0)
        v = scaled(math.sqrt(physics.kT / m), normals(like, a, b, e, f))
        n, mass, momentum = n + number, mass + m, added(momentum, scaled(m, v))
        if asks(physics.energy):
            inner = gamma_number(float(d * (number - 1)), counter, BODY_NUMBER, cell)
            energy += m * dot(v, v) + 2.0 * physics.kT * inner
        who = (FIRST_NUMBER + len(solutes.cell) + np.int64(cell), 0)
        _, drawn = contribute(physics.rule, counter, who, m, v, scaled(0.0, like))
        own = added(own, drawn)
    return n, mass, momentum, energy, own


@by_type
def put_answers(solutes, *rest):
    """Put them in the place of those that `solve` found without beads."""
    return _put_answers if len(solutes) else lambda *_: None


def _put_answers(solutes, thread, threads, coefficients, number, c):
    first, last = cells_of_thread(thread, threads, number)
    for i in range(len(solutes.cell)):
        cell = solutes.cell[i]
        if first <= cell < last and solutes.leads[i]:
            start = np.uint64(cell) * np.uint64(record_length(len(c)))
            put(coefficients, start, fetch(solutes.answers, np.uint64(i * len(c)), c))
