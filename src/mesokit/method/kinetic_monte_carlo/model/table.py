"""Models as tables: processes of a site, or of a site and a neighbour, and their rates.

The rate of a process may depend on how many neighbours are in which states. All rates of a site
then follow from one number, that of its surroundings: a sum over the neighbours of weights that
depend on both states. When one neighbour changes, one difference of weights is added to it.
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
    of which is that of the missing ones. counted: groups of states on whose numbers it depends;
    the first of a group has the number of all.
    neighbour: states of a neighbour that may take part, and that after it; the state after the last
    one stands for a missing neighbour. directions: of that neighbour (all unless said).
    """

    name: str
    site: tuple[int, int]
    rate: float | Callable[[Counts], float]
    counted: tuple[tuple[int, ...], ...] = ()
    neighbour: tuple[tuple[int, ...], int] | None = None
    directions: tuple[int, ...] | None = None

    def takes(self, direction: int, state: int) -> bool:
        """Whether a neighbour in a direction and a state takes part."""
        if self.neighbour is None or state not in self.neighbour[0]:
            return False
        return self.directions is None or direction in self.directions


@component
class TableModel(Model, ABC):
    """A model whose processes are a table."""

    @abstractmethod
    def processes(self) -> list[Process]:
        """What may happen."""

    def kernel(self, kind: Kind, ends: bool) -> Table:
        """The table of the processes."""
        number, ordered = len(self.states()), in_order(self.processes())
        return Table(
            number,
            np.array([one.site[1] for one in ordered]),
            np.array([-1 if one.neighbour is None else one.neighbour[1] for one in ordered]),
            rates_of(ordered, number, number, kind, ends),
        )

    def events(self) -> list[str]:
        """Names of the processes."""
        return [one.name for one in in_order(self.processes())]


class Table(NamedTuple):
    """Processes as kernels take them.

    number: states a site may have. new, beside: (processes,) states of the site and of the
    neighbour after each. of: their rates.
    """

    number: int
    new: NDArray[np.int64]
    beside: NDArray[np.int64]
    of: Rates

    @property
    def rates(self) -> NDArray[np.float64]:
        """Rates (m,) of all processes together, by surroundings."""
        return self.of.rates


class Rates(NamedTuple):
    """The rates of processes that are in the order of their states, by surroundings.

    begin: (states + 1,) first process of each state. first: (states,) number of surroundings with
    each state. weights: (neighbours * states * (others + 1),) by direction, state of the site and
    state of the neighbour. rates: (m,) of all processes together. shares: (m * processes,), for
    each neighbour that takes part. fits: (processes,) a bit for each state of a neighbour that may
    take part, 0 without a neighbour. towards: a bit for each direction.
    """

    begin: NDArray[np.int64]
    first: NDArray[np.int32]
    weights: NDArray[np.int32]
    rates: NDArray[np.float64]
    shares: NDArray[np.float64]
    fits: NDArray[np.int64]
    towards: NDArray[np.int64]


def in_order(processes: Sequence[Process]) -> list[Process]:
    """Processes by the state that they begin with: so they are numbered."""
    return sorted(processes, key=lambda one: one.site[0])


def rates_of(ordered: Sequence[Process], states: int, others: int, kind: Kind, ends: bool) -> Rates:
    """The rates of processes on a lattice, with so many states of a site and of a neighbour."""
    z = kind.neighbours
    first = np.zeros(states, np.int32)
    rates: list[float] = []
    shares: list[NDArray[np.float64]] = []
    weights = np.zeros((z, states, others + 1), np.int32)
    for state in range(states):
        own = [(p, one) for p, one in enumerate(ordered) if one.site[0] == state]
        first[state] = len(rates)
        features, most = _features(own, others, z, ends)
        strides = np.cumprod([1, *(number + 1 for number in most)])
        if len(rates) + strides[-1] > MOST:
            raise CaseError(
                f"lattice.model: {len(rates) + strides[-1]} kinds of surroundings of a site; "
                f"expected at most {MOST}"
            )
        for (k, b), feature in features.items():
            weights[k, state, b] = strides[feature] if feature >= 0 else 0
        all_matter = -1 not in features.values()  # then each neighbour is of some feature
        for counts in itertools.product(*(range(number + 1) for number in reversed(most))):
            share, total = np.zeros(len(ordered)), 0.0
            if sum(counts) == z if all_matter else sum(counts) <= z:
                found, partners = _counts(counts[::-1], features, own, others)
                for p, one in own:
                    share[p] = one.rate(found) if callable(one.rate) else one.rate
                    total += share[p] * (1 if one.neighbour is None else partners[p])
            rates.append(total)
            shares.append(share)
    begin = np.searchsorted([one.site[0] for one in ordered], range(states + 1))
    partner = [() if one.neighbour is None else one.neighbour[0] for one in ordered]
    every = range(z)
    return Rates(
        begin.astype(np.int64),
        first,
        weights.ravel(),
        np.array(rates),
        np.array(shares).ravel(),
        np.array([sum(1 << b for b in some) for some in partner]),
        np.array([sum(1 << k for k in (one.directions or every)) for one in ordered]),
    )


def _features(
    own: Sequence[tuple[int, Process]], others: int, z: int, ends: bool
) -> tuple[dict[tuple[int, int], int], list[int]]:
    """Which neighbours are alike for the processes of a state: a number for each direction and
    state of the neighbour, -1 where it does not matter; and how many neighbours may have it."""
    alike: dict[object, int] = {}
    found: dict[tuple[int, int], int] = {}
    where: list[set[int]] = []
    for k, b in itertools.product(range(z), range(others + ends)):
        takes_part = tuple(p for p, one in own if one.takes(k, b))
        counted = tuple(some for _, one in own for some in one.counted if b in some)
        if not takes_part and not counted:
            found[k, b] = -1
            continue
        found[k, b] = alike.setdefault((takes_part, counted), len(alike))
        if found[k, b] == len(where):
            where.append(set())
        where[found[k, b]].add(k)
    return found, [len(directions) for directions in where]


def _counts(
    counts: Sequence[int],
    features: dict[tuple[int, int], int],
    own: Sequence[tuple[int, Process]],
    others: int,
) -> tuple[list[int], dict[int, int]]:
    """Neighbours in each state, or in one of those that are alike, and those that take part."""
    found, partners = [0] * (others + 1), {p: 0 for p, _ in own}
    for feature, number in enumerate(counts):
        k, b = next(key for key, one in features.items() if one == feature)
        groups = {some for _, one in own for some in one.counted if b in some}
        for some in groups:
            found[some[0]] += number
        for p, one in own:
            partners[p] += number * one.takes(k, b)
    return found, partners


@surroundings.register(Table)
def _(model, sites, i):
    state = np.int64(sites.states[i])
    around = np.int64(model.of.first[state])
    row, step = state * (model.number + 1), model.number * (model.number + 1)
    for direction in range(sites.grid.neighbours):
        j = neighbour(sites.grid, i, direction)
        around += model.of.weights[row + (np.int64(sites.states[j]) if j >= 0 else model.number)]
        row += step
    return around


@surroundings_after.register(Table)
def _(model, sites, i, direction, old, new):
    row = (direction * model.number + np.int64(sites.states[i])) * (model.number + 1)
    change = np.int64(model.of.weights[row + new]) - np.int64(model.of.weights[row + old])
    return np.int64(sites.around[i]) + change


@process_of.register(Table)
def _(model, sites, i, u):
    # the processes of this state, one neighbour after the other, until their rates make up u of all
    state, around = np.int64(sites.states[i]), np.int64(sites.around[i])
    left, row = u * model.of.rates[around], around * len(model.new)
    last, chosen, target = 0, -1, -1
    for p in range(model.of.begin[state], model.of.begin[state + 1]):
        rate = model.of.shares[row + p]
        if rate > 0.0 and model.of.fits[p] == 0:
            last, chosen, target, left = p, -1, -1, left - rate
        elif rate > 0.0:
            for direction in range(sites.grid.neighbours):
                if (model.of.towards[p] >> direction) & 1:
                    j = neighbour(sites.grid, i, direction)
                    there = np.int64(sites.states[j]) if j >= 0 else model.number
                    if (model.of.fits[p] >> there) & 1:
                        last, chosen, target, left = p, direction, j, left - rate
                        if left < 0.0:
                            break
        if left < 0.0:
            break
    return last, model.new[last], chosen, target, model.beside[last]
