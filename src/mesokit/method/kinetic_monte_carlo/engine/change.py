"""What happens at a site, or to two neighbours, and what changes with it: states, the surroundings
of the sites near, and their rates.

A place is that of a site, unless the model says that it is that of a bond (`bonds.py`).
"""

import numpy as np

from mesokit.method.kinetic_monte_carlo.engine.choice import keeps, put
from mesokit.method.kinetic_monte_carlo.engine.record import change_recorded
from mesokit.method.kinetic_monte_carlo.lattice.grid import first_jump, jump, neighbour
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    MISSING,
    UNLIKE,
    change_of_any,
    change_of_own,
    change_of_weight,
    number_alone,
    process_of,
    weight,
)
from mesokit.scalar.jit import generic, scalar

U = np.uint64
NONE = -(2**62)  # in place of a neighbour: no neighbour has it


@generic
def found(model, sites, place):
    """The number of the surroundings of what is at a place, from the states around it."""


@generic
def known(model, sites, place):
    """The same, where it is kept."""


@generic
def set_around(model, sites, choice, part, i, around):
    """Set the number of the surroundings of a site."""


@generic
def settle(model, sites, choice, part, i, j):
    """Set the rates of bonds after the surroundings of sites near i, and near j, have changed."""


@generic
def settle_all(model, sites, choice, i):
    """Set the rates of all bonds of the site at a place, for the first time."""


@generic
def settle_rim(model, sites, choice, part, i):
    """Set the rates in a part of what is at a site, from the surroundings that are known."""


@generic
def happen(model, sites, choice, part, place, u):
    """Let something happen at a place, drawn by a number u uniform in [0, 1): the number of the
    process, and the direction of the neighbour that took part, or -1."""


@scalar
def surroundings(model, sites, i):
    """The number of the surroundings of the site at a place, from the states around it."""
    state = np.int64(sites.states[U(i)])
    around = number_alone(model, state)
    for direction in range(sites.grid.neighbours):
        j = neighbour(sites.grid, i, direction)
        other = np.int64(sites.states[U(j)]) if j >= 0 else MISSING
        around += weight(model, direction, state, other)
    return around


@scalar
def _change_around(model, sites, choice, part, i, old, j, before):
    """Change the surroundings of a site whose state was another, and of its neighbours, after the
    state of the neighbour at j has changed too; those of j are left for later."""
    new = np.int64(sites.states[U(i)])
    # in most models the number of the site's own surroundings changes by one and the same
    own = change_of_own(model, old, new)
    around = np.int64(sites.around[U(i)]) + own
    every, first = change_of_any(model, old, new), first_jump(sites.grid, i)
    for direction in range(sites.grid.neighbours):
        k = i + jump(sites.grid, first, direction)
        if k == j:
            other = np.int64(sites.states[U(k)])
            around += change_of_weight(model, direction, new, before, other)
        elif k >= 0:
            change = every
            if every == UNLIKE:
                back, state = sites.grid.back[U(direction)], np.int64(sites.states[U(k)])
                change = change_of_weight(model, back, state, old, new)
            set_around(model, sites, choice, part, k, np.int64(sites.around[U(k)]) + change)
    if own == UNLIKE:
        around = surroundings(model, sites, i)
    set_around(model, sites, choice, part, i, around)


@scalar
def change(model, sites, choice, part, i, new, j, other):
    """Change the state of a site, and of a neighbour if j is not negative."""
    old, before = np.int64(sites.states[U(i)]), np.int64(0)
    sites.states[U(i)] = new
    if j >= 0:
        before = np.int64(sites.states[U(j)])
        sites.states[U(j)] = other
    if sites.record.on:
        change_recorded(sites.record, sites.grid, (i, old, new), (j, before, other))
    if not keeps(choice):
        return
    if j >= 0:
        _change_around(model, sites, choice, part, i, old, j, before)
        _change_around(model, sites, choice, part, j, before, i, old)
    elif old != new:
        _change_around(model, sites, choice, part, i, old, NONE, before)
    settle(model, sites, choice, part, i, j)


@found.otherwise
def _(model, sites, place):
    around = surroundings(model, sites, place)
    sites.around[U(place)] = around
    return around


@known.otherwise
def _(model, sites, place):
    return np.int64(sites.around[U(place)])


@set_around.otherwise
def _(model, sites, choice, part, i, around):
    sites.around[U(i)] = around
    put(choice, part, i, around)


@settle.otherwise
def _(model, sites, choice, part, i, j):
    pass


@settle_all.otherwise
def _(model, sites, choice, i):
    pass


@settle_rim.otherwise
def _(model, sites, choice, part, i):
    put(choice, part, i, np.int64(sites.around[U(i)]))


@happen.otherwise
def _(model, sites, choice, part, place, u):
    process, new, direction, j, other = process_of(model, sites, place, u)
    change(model, sites, choice, part, place, new, j, other)
    return process, direction
