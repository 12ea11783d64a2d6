"""Choice by attempts: a site is drawn, whatever its rate, and what may happen there does so with
the probability of its rate over the largest one. Nothing is kept of the sites; time goes on with
each attempt, in vain or not. It is the fastest where most attempts are not in vain.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.method.kinetic_monte_carlo.engine.choice import (
    chance,
    choose,
    fetch,
    foresee,
    keeps,
    planes_of,
    put,
    total_rate,
)
from mesokit.method.kinetic_monte_carlo.lattice.grid import fetch_site, place
from mesokit.scalar.intrinsics import with_item
from mesokit.scalar.jit import scalar
from mesokit.method.kinetic_monte_carlo.engine.stream import unit_of

AHEAD = 8  # attempts: when a site is fetched
U = np.uint64


class Attempts(NamedTuple):
    """Attempts at the sites or bonds of a lattice.

    size: (d,) of the lattice. sites: how many. planes: places of bonds at each site, 1 for sites;
    memory: places of sites. highest: rate of attempts at each of these. chances: (m,) rates
    over the highest one, by surroundings.
    """

    size: tuple[int, ...]
    sites: int
    planes: int
    memory: int
    highest: float
    chances: NDArray[np.float64]


@put.register(Attempts)
def _(choice, part, i, around):
    pass


@total_rate.register(Attempts)
def _(choice, part):
    # a bond is drawn from both of its ends
    return choice.sites * choice.highest * (0.5 * choice.planes if choice.planes > 1 else 1)


@scalar
def _drawn(choice, sites, u):
    along = u * choice.planes
    plane = np.int64(along)
    u, r = along - plane, choice.size
    for k in range(len(r)):
        along = u * choice.size[k]
        x = np.int64(along)
        r, u = with_item(r, k, x), along - x
    return place(sites.grid, r) + plane * choice.memory


@choose.register(Attempts)
def _(choice, sites, part, total, u, word):
    return _drawn(choice, sites, u), unit_of(word)


@foresee.register(Attempts)
def _(choice, sites, total, numbers):
    for k in range(AHEAD):
        fetch_site(sites, _drawn(choice, sites, numbers.units[U(k)]) % len(sites.states))


@fetch.register(Attempts)
def _(choice, sites, numbers, k):
    if k + AHEAD < len(numbers.units):
        place = _drawn(choice, sites, numbers.units[U(k + AHEAD)])
        fetch_site(sites, place % len(sites.states))


@chance.register(Attempts)
def _(choice, around):
    return choice.chances[np.uint64(around)]


@keeps.register(Attempts)
def _(choice):
    return False


@planes_of.register(Attempts)
def _(choice):
    return choice.planes
