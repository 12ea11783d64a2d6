"""Exchange of neighbours: what is chosen is a bond, and its rate depends on what is around both.

A bond has the place of the one of its two sites that comes first in memory, in the plane of memory
of the direction from there.
"""

import numpy as np

from mesokit.method.kinetic_monte_carlo.engine.change import (
    change,
    found,
    happen,
    known,
    set_around,
    settle,
    settle_all,
    settle_rim,
    surroundings,
)
from mesokit.method.kinetic_monte_carlo.engine.choice import ANY, put
from mesokit.method.kinetic_monte_carlo.lattice.grid import neighbour
from mesokit.method.kinetic_monte_carlo.model.exchange import Exchanges
from mesokit.scalar.jit import scalar

U = np.uint64


@scalar
def _put_bonds(model, sites, choice, part, i):
    """Set the rates of all bonds of a site."""
    memory, own = len(sites.states), np.int64(sites.around[U(i)])
    for direction in range(sites.grid.neighbours):
        j = neighbour(sites.grid, i, direction)
        if j >= 0:
            other, back = np.int64(sites.around[U(j)]), sites.grid.back[U(direction)]
            if i < j:
                put(choice, part, direction * memory + i, own * model.numbers + other)
            else:
                put(choice, part, back * memory + j, other * model.numbers + own)


@known.register(Exchanges)
def _(model, sites, place):
    memory = len(sites.states)
    direction = place // memory
    i = place - direction * memory
    j = neighbour(sites.grid, i, direction)
    # attempts may draw a bond that ends outside: its surroundings are those of two alike
    other = np.int64(sites.around[U(j)]) if j >= 0 else np.int64(sites.around[U(i)])
    return np.int64(sites.around[U(i)]) * model.numbers + other


@found.register(Exchanges)
def _(model, sites, place):
    memory = len(sites.states)
    i = place % memory
    j = neighbour(sites.grid, i, place // memory)
    sites.around[U(i)] = surroundings(model, sites, i)
    if j >= 0:
        sites.around[U(j)] = surroundings(model, sites, j)
    return known(model, sites, place)


@set_around.register(Exchanges)
def _(model, sites, choice, part, i, around):
    sites.around[U(i)] = around


@settle_all.register(Exchanges)
def _(model, sites, choice, i):
    _put_bonds(model, sites, choice, ANY, i)


@settle_rim.register(Exchanges)
def _(model, sites, choice, part, i):
    _put_bonds(model, sites, choice, part, i)


@settle.register(Exchanges)
def _(model, sites, choice, part, i, j):
    _put_bonds(model, sites, choice, part, i)
    for direction in range(sites.grid.neighbours):
        k = neighbour(sites.grid, i, direction)
        if k >= 0:
            _put_bonds(model, sites, choice, part, k)
    if j >= 0:
        for direction in range(sites.grid.neighbours):
            k = neighbour(sites.grid, j, direction)
            if k >= 0:
                _put_bonds(model, sites, choice, part, k)


@happen.register(Exchanges)
def _(model, sites, choice, part, place, u):
    memory = len(sites.states)
    direction = place // memory
    i = place - direction * memory
    j = neighbour(sites.grid, i, direction)
    one, other = np.int64(sites.states[U(i)]), np.int64(sites.states[U(j)])
    change(model, sites, choice, part, i, other, j, one)
    return 0, direction
