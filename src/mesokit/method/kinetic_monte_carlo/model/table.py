"""Models as tables: processes of a site, or of a site and a neighbour, and their rates.

A process changes the state of a site, and of one neighbour if it has one. Its rate may depend on
how many neighbours are in which states. All rates of a site then follow from one number, that of
its surroundings: a sum over the neighbours of weights that depend on both states.
"""

from __future__ import annotations

import itertools
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.lattice.grid import neighbour
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    Model,
    process_of,
    surroundings,
    surroundings_after,
)

Counts = Sequence[int]  # of neighbours in each state, and of those that are missing
MOST = 2**15  # surroundings


class Process(NamedTuple):
    """What may happen at a site.

    name: in results. site: its state before and after. rate: events in a unit of time, for each
    neighbour that takes part; or a function of the numbers of neighbours in each state, the last
    of which is that of the missing ones. counted: the states on whose numbers it depends.
    neighbour: state of a neighbour before and after; the state after the last stands for none.
    directions: of that neighbour (all unless said).
    """

    name: str
    site: tuple[int, int]
    rate: float | Callable[[Counts], float]
    counted: tuple[int, ...] = ()
    neighbour: tuple[int, int] | None = None
    directions: tuple[int, ...] | None = None


@component
class TableModel(Model, ABC):
    """A model whose processes are a table."""

    @abstractmethod
    def processes(self) -> list[Process]:
        """What may happen, by the state of the site that it begins with."""

    def kernel(self, kind: Kind, ends: bool) -> Table:
        """The table of the processes."""
        return table_of(self.processes(), len(self.states()), kind, ends)

    def events(self) -> list[str]:
        """Names of the processes."""
        return [one.name for one in in_order(self.processes())]


class Table(NamedTuple):
    """Processes as kernels take them.

    number: states a site may have. first: (number,) of surroundings with each state. weights:
    (neighbours * number * (number + 1),) by direction, state and the neighbour's. rates: (m,) of
    all processes together, by surroundings. shares: (m * processes,), for each neighbour of those
    that have one. begin: (number + 1,) first process of each state. before, after: of the
    neighbour, -1 for none. turns: state of the site after. ways: a bit for each direction.
    """

    number: int
    first: NDArray[np.int32]
    weights: NDArray[np.int32]
    rates: NDArray[np.float64]
    shares: NDArray[np.float64]
    begin: NDArray[np.int64]
    turns: NDArray[np.int64]
    before: NDArray[np.int64]
    after: NDArray[np.int64]
    ways: NDArray[np.int64]


def in_order(processes: Sequence[Process]) -> list[Process]:
    """Processes by the state that they begin with: so they are numbered."""
    return sorted(processes, key=lambda one: one.site[0])


def table_of(processes: Sequence[Process], number: int, kind: Kind, ends: bool) -> Table:
    """The table of processes on a lattice with so many states of a site."""
    ordered, z = in_order(processes), kind.neighbours
    first, rates, shares = np.zeros(number, np.int32), [], []
    weights = np.zeros((z, number, number + 1), np.int32)
    for state in range(number):
        own = [(p, one) for p, one in enumerate(ordered) if one.site[0] == state]
        first[state] = len(rates)
        features, sizes = _features(own, number, z, ends)
        place_of = np.cumprod([1, *(size + 1 for size in sizes)])
        if len(rates) + place_of[-1] > MOST:
            raise CaseError(
                f"lattice.model: {len(rates) + place_of[-1]} kinds of surroundings of a site; "
                f"expected at most {MOST}"
            )
        for (k, b), feature in features.items():
            if feature >= 0:
                weights[k, state, b] = place_of[feature]
        all_matter = -1 not in features.values()  # then each neighbour is of some feature
        for found in itertools.product(*(range(size + 1) for size in reversed(sizes))):
            share = np.zeros(len(ordered))
            total = 0.0
            if sum(found) == z if all_matter else sum(found) <= z:
                counts, partners = _counts(found[::-1], features, own, number)
                for p, one in own:
                    share[p] = one.rate(counts) if callable(one.rate) else one.rate
                    total += share[p] * (1 if one.neighbour is None else partners[p])
            rates.append(total)
            shares.append(share)
    begin = np.searchsorted([one.site[0] for one in ordered], range(number + 1))
    pairs = [one.neighbour or (-1, -1) for one in ordered]
    every = range(z)
    return Table(
        number,
        first,
        weights.ravel(),
        np.array(rates),
        np.array(shares).ravel(),
        begin.astype(np.int64),
        np.array([one.site[1] for one in ordered]),
        np.array([before for before, _ in pairs]),
        np.array([after for _, after in pairs]),
        np.array([sum(1 << k for k in (one.directions or every)) for one in ordered]),
    )


def _features(
    own: Sequence[tuple[int, Process]], number: int, z: int, ends: bool
) -> tuple[dict[tuple[int, int], int], list[int]]:
    """Which neighbours are alike for the processes of a state: a number for each direction and
    state of the neighbour, -1 where it does not matter; and how many neighbours may have it."""
    counted = {state for _, one in own for state in one.counted}
    alike: dict[object, int] = {}
    found, most = {}, {}
    for k, b in itertools.product(range(z), range(number + ends)):
        takes_part = tuple(
            p
            for p, one in own
            if one.neighbour is not None
            and one.neighbour[0] == b
            and (one.directions is None or k in one.directions)
        )
        if not takes_part and b not in counted:
            found[k, b] = -1
            continue
        feature = alike.setdefault((takes_part, b), len(alike))
        found[k, b] = feature
        most.setdefault(feature, set()).add(k)
    return found, [len(most[feature]) for feature in range(len(alike))]


def _counts(
    found: Sequence[int],
    features: dict[tuple[int, int], int],
    own: Sequence[tuple[int, Process]],
    number: int,
) -> tuple[list[int], dict[int, int]]:
    """Neighbours in each state, and those that take part in each process."""
    counts, partners = [0] * (number + 1), {p: 0 for p, _ in own}
    for feature, how_many in enumerate(found):
        k, b = next(key for key, one in features.items() if one == feature)
        counts[b] += how_many
        for p, one in own:
            if one.neighbour is not None and one.neighbour[0] == b:
                if one.directions is None or k in one.directions:
                    partners[p] += how_many
    return counts, partners


@surroundings.register(Table)
def _(model, sites, i):
    state = np.int64(sites.states[i])
    around = np.int64(model.first[state])
    row, step = state * (model.number + 1), model.number * (model.number + 1)
    for direction in range(sites.grid.neighbours):
        j = neighbour(sites.grid, i, direction)
        around += model.weights[row + (np.int64(sites.states[j]) if j >= 0 else model.number)]
        row += step
    return around


@surroundings_after.register(Table)
def _(model, sites, i, direction, old, new):
    row = (direction * model.number + np.int64(sites.states[i])) * (model.number + 1)
    change = np.int64(model.weights[row + new]) - np.int64(model.weights[row + old])
    return np.int64(sites.around[i]) + change


@process_of.register(Table)
def _(model, sites, i, u):
    # the processes of this state, one neighbour after the other, until their rates make up u of all
    state, around = np.int64(sites.states[i]), np.int64(sites.around[i])
    left, row = u * model.rates[around], around * len(model.turns)
    last, towards, target = 0, -1, -1
    for p in range(model.begin[state], model.begin[state + 1]):
        rate = model.shares[row + p]
        if rate > 0.0 and model.before[p] < 0:
            last, towards, left = p, -1, left - rate
        elif rate > 0.0:
            for direction in range(sites.grid.neighbours):
                if (model.ways[p] >> direction) & 1:
                    j = neighbour(sites.grid, i, direction)
                    there = np.int64(sites.states[j]) if j >= 0 else model.number
                    if there == model.before[p]:
                        last, towards, target, left = p, direction, j, left - rate
                        if left < 0.0:
                            break
        if left < 0.0:
            break
    return last, model.turns[last], towards, target, model.after[last]
