"""Models of growth: columns of atoms on the sites, whose heights change.

All that counts of a neighbour is how much higher or lower its column is, up to a few atoms.
"""

from __future__ import annotations

import functools
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component
from mesokit.method.kinetic_monte_carlo.lattice.grid import neighbour
from mesokit.method.kinetic_monte_carlo.lattice.kinds import KINDS, Kind
from mesokit.method.kinetic_monte_carlo.lattice.patch import Patch
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    MISSING,
    UNLIKE,
    Known,
    Model,
    Move,
    Moves,
    change_of_any,
    change_of_own,
    change_of_weight,
    number_alone,
    process_of,
    weight,
)
from mesokit.method.kinetic_monte_carlo.model.table import (
    Process,
    Rates,
    rates_of,
    weight_in,
)
from mesokit.scalar.bits import bits_set, nth_bit
from mesokit.scalar.jit import scalar

FAR = 3  # atoms: larger differences of heights are as good as this
LEVEL = FAR  # the place of a neighbour that is as high, among the differences from -FAR to FAR
LOWER, HIGHER = tuple(range(LEVEL)), tuple(range(LEVEL + 1, 2 * FAR + 1))
AT_LEAST_AS_HIGH, ANY = (LEVEL, *HIGHER), tuple(range(2 * FAR + 1))
# where an atom that comes down stays: at its site, at the lowest of the site and its neighbours, or
# where it first touches the column or one beside it
HERE, LOWEST, BESIDE = 0, 1, 2
# growth exponent of a driven surface on a chain
KPZ: Known = (1 / 3, "approximate: Kardar, Parisi and Zhang, at late times")
U = np.uint64


class Growth(NamedTuple):
    """A process of a column, and of one beside it.

    process: its states of neighbours are differences of heights, from -FAR to FAR, with LEVEL in
    the middle. site, beside: atoms that the two columns gain. stays: HERE, LOWEST or BESIDE.
    """

    process: Process
    site: int
    beside: int = 0
    stays: int = HERE


@component
class HeightModel(Model, ABC):
    """A model of growth."""

    @abstractmethod
    def growth(self, kind: Kind) -> list[Growth]:
        """What may happen."""

    def states(self) -> tuple[str, ...]:
        """None have names: the state of a site is its height."""
        return ()

    def kernel(self, kind: Kind, ends: bool) -> Heights:
        """The table of the processes."""
        found = self.growth(kind)
        processes = [one.process for one in found]
        return Heights(
            np.array([one.site for one in found]),
            np.array([one.beside for one in found]),
            np.array([one.stays for one in found]),
            rates_of(processes, 1, 2 * FAR + 1, kind, ends),
        )

    def events(self) -> list[str]:
        """Names of the processes."""
        return [one.process.name for one in self.growth(KINDS["square"])]

    def list_moves(self, kind: Kind) -> Moves | None:
        """Growth at a site; None where it depends on more than the site that is chosen."""
        found = self.growth(kind)
        if any(one.stays != HERE for one in found):
            return None
        return Moves(functools.partial(growth_moves, found))


def growth_moves(found: Sequence[Growth], patch: Patch, i: int) -> Iterator[Move]:
    """What may happen to a column of a patch."""
    height, missing = patch.states[i], 2 * FAR + 1
    heights = patch.around(i, height)
    around = [
        missing if j < 0 else min(max(other - height, -FAR), FAR) + FAR
        for j, other in zip(patch.near[i], heights, strict=True)
    ]
    for one in found:
        process, new = one.process, (i, height + one.site)
        rate = process.rate_at(around, missing)
        if rate > 0 and process.neighbour is None:
            yield Move(process.name, rate, (new,))
        for k, there in enumerate(around if rate > 0 else ()):
            if there != missing and process.takes(k, there):
                yield Move(process.name, rate, (new, (patch.near[i][k], heights[k] + one.beside)))


class Heights(NamedTuple):
    """Processes of growth as kernels take them.

    site, beside, stays: (processes,) of `Growth`. of: their rates.
    """

    site: NDArray[np.int64]
    beside: NDArray[np.int64]
    stays: NDArray[np.int64]
    of: Rates

    @property
    def rates(self) -> NDArray[np.float64]:
        """Rates (m,) of all processes together, by surroundings."""
        return self.of.rates


@scalar
def _difference(height, other):
    """Where the height of a neighbour stands among the differences."""
    higher = other - height
    higher = higher if higher > -FAR else -FAR
    return (higher if higher < FAR else FAR) + FAR


@number_alone.register(Heights)
def _(model, state):
    return np.int64(0)


@weight.register(Heights)
def _(model, direction, state, other):
    there = _difference(state, other) if other != MISSING else np.int64(2 * FAR + 1)
    return weight_in(model.of, direction, np.int64(0), there)


@change_of_weight.register(Heights)
def _(model, direction, state, old, new):
    before, after = _difference(state, old), _difference(state, new)
    of = model.of
    return weight_in(of, direction, np.int64(0), after) - weight_in(
        of, direction, np.int64(0), before
    )


@change_of_any.register(Heights)
def _(model, old, new):
    return np.int64(UNLIKE)


@change_of_own.register(Heights)
def _(model, old, new):
    return np.int64(UNLIKE)


@process_of.register(Heights)
def _(model, sites, i, u):
    height, around = np.int64(sites.states[U(i)]), np.int64(sites.around[U(i)])
    left, row = u * model.of.rates[U(around)], around * len(model.site)
    last, chosen, target, rate = np.int64(0), np.int64(-1), np.int64(-1), 1.0
    for p in range(len(model.site)):
        share = model.of.shares[U(row + p)]
        if share > 0.0 and model.of.fits[U(p)] == 0:
            last, chosen, rate, left = np.int64(p), np.int64(-1), share, left - share
        elif share > 0.0:
            fitting = np.uint64(0)  # a bit for each direction with a neighbour that takes part
            for direction in range(sites.grid.neighbours):
                j = neighbour(sites.grid, i, direction)
                if j >= 0:
                    there = _difference(height, np.int64(sites.states[U(j)]))
                    fitting |= U((model.of.fits[U(p)] >> there) & 1) << U(direction)
            number = np.int64(bits_set(fitting))
            if number > 0:
                rank = min(np.int64(left / share), number - 1)
                last, chosen, rate = np.int64(p), np.int64(nth_bit(fitting, rank)), share
                target, left = neighbour(sites.grid, i, chosen), left - number * share
        if left < 0.0:
            break
    if chosen >= 0:
        return (
            last,
            height + model.site[last],
            chosen,
            target,
            (np.int64(sites.states[target]) + model.beside[last]),
        )
    if model.stays[last] == LOWEST:
        # among columns as low as the lowest, by what is left of the random number; first the site
        lowest, ties, here = np.int64(height), 0, True
        for direction in range(sites.grid.neighbours):
            j = neighbour(sites.grid, i, direction)
            if j >= 0 and np.int64(sites.states[j]) < lowest:
                lowest, ties, here = np.int64(sites.states[j]), 0, False
            if j >= 0 and np.int64(sites.states[j]) == lowest:
                ties += 1
        if not here:
            rank = np.int64(min(int((left / rate + 1.0) * ties), ties - 1))
            for direction in range(sites.grid.neighbours):
                j = neighbour(sites.grid, i, direction)
                if j >= 0 and np.int64(sites.states[j]) == lowest:
                    if rank == 0:
                        return last, height, direction, j, lowest + 1
                    rank -= 1
    top = height + model.site[last]
    if model.stays[last] == BESIDE:
        for direction in range(sites.grid.neighbours):
            j = neighbour(sites.grid, i, direction)
            if j >= 0:
                other = np.int64(sites.states[j])
                top = other if other > top else top
    return last, top, -1, -1, 0
