"""Models as tables: processes of a site, or of a site and a neighbour, and their rates.

The rate of a process may depend on how many neighbours are in which states. All rates of a site
then follow from one number, that of its surroundings: a sum over the neighbours of weights that
depend on both states. When one neighbour changes, one difference of weights is added to it.
"""

from __future__ import annotations

import functools
import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, show
from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.lattice.grid import neighbour
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.lattice.patch import Patch
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    UNLIKE,
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
from mesokit.scalar.bits import bits_set, nth_bit
from mesokit.scalar.jit import scalar

Counts = Sequence[int]  # of neighbours in each state, and of those that are missing
MOST = 2**15  # surroundings
U = np.uint64


class Process(NamedTuple):
    """What may happen at a site.

    name: in results. site: its state before and after. rate: events in a unit of time, for each
    neighbour that takes part; or a function of the numbers of neighbours in each state, the last
    of which is that of the missing ones. counted: groups of states on whose numbers it depends;
    the first of a group has the number of all, so that groups begin with different states.
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

    def rate_at(self, around: Sequence[int], missing: int) -> float:
        """Its rate, by the states of the neighbours; `missing` stands for one that is not there."""
        if not callable(self.rate):
            return self.rate
        counts = [0] * (missing + 1)
        for some in self.counted:
            counts[some[0]] = sum(state in some for state in around)
        return self.rate(counts)


def moves_of(processes: Sequence[Process], missing: int, patch: Patch, i: int) -> Iterator[Move]:
    """What may happen at a site of a patch."""
    around = patch.around(i, missing)
    for one in processes:
        if one.site[0] == patch.states[i] and (rate := one.rate_at(around, missing)) > 0:
            new = i, one.site[1]
            if one.neighbour is None:
                yield Move(one.name, rate, (new,))
                continue
            for direction, state in enumerate(around):
                if one.takes(direction, state):
                    j = patch.near[i][direction]
                    beside = ((j, one.neighbour[1]),) if j >= 0 else ()
                    yield Move(one.name, rate, (new, *beside))


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

    def list_moves(self, kind: Kind) -> Moves | None:
        """The processes of the table."""
        return Moves(functools.partial(moves_of, self.processes(), len(self.states())))


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
    each state. bits: of a state, or that of a neighbour, in an index. weights: by direction, state
    of the neighbour and of the site. own: by two states of a site, the difference of `first`, or
    UNLIKE where weights differ too. of_any: by two states of a neighbour, the difference of
    weights if it is the same for all directions and states of the site, or UNLIKE. rates: (m,) of
    all processes together. shares: (m * processes,), for each neighbour that takes part. fits:
    (processes,) a bit for each state of a neighbour that may take part, 0 without a neighbour.
    towards: a bit for each direction.
    """

    begin: NDArray[np.int64]
    first: NDArray[np.int32]
    bits: int
    weights: NDArray[np.int32]
    own: NDArray[np.int64]
    of_any: NDArray[np.int64]
    rates: NDArray[np.float64]
    shares: NDArray[np.float64]
    fits: NDArray[np.int64]
    towards: NDArray[np.int64]


@scalar
def weight_in(of, direction, state, other):
    """The weight of a neighbour in the number of surroundings."""
    return np.int64(of.weights[U((((direction << of.bits) | other) << of.bits) | state)])


def in_order(processes: Sequence[Process]) -> list[Process]:
    """Processes by the state that they begin with: so they are numbered."""
    return sorted(processes, key=lambda one: one.site[0])


def rates_of(ordered: Sequence[Process], states: int, others: int, kind: Kind, ends: bool) -> Rates:
    """The rates of processes on a lattice, with so many states of a site and of a neighbour."""
    z = kind.neighbours
    for one in ordered:
        _check_states(one, states, others)
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
        kinds = list({f: key for key, f in features.items() if f >= 0}.values())
        all_matter = -1 not in features.values()  # then each neighbour is of some feature
        for counts in itertools.product(*(range(number + 1) for number in reversed(most))):
            share, total = np.zeros(len(ordered)), 0.0
            if sum(counts) == z if all_matter else sum(counts) <= z:
                for p, one in own:
                    found, partners = _counts(counts[::-1], kinds, one, others)
                    share[p] = _rate_of(one, found)
                    total += share[p] * (1 if one.neighbour is None else partners)
            rates.append(total)
            shares.append(share)
    bits = int(max(states - 1, others)).bit_length()
    padded = np.zeros((z, 1 << bits, 1 << bits), np.int32)
    padded[:, : others + 1, :states] = weights.transpose(0, 2, 1)
    change = np.full((1 << bits, 1 << bits), UNLIKE)
    for old, new in itertools.product(range(states), repeat=2):
        if (weights[:, old] == weights[:, new]).all():
            change[old, new] = int(first[new]) - int(first[old])
    of_any = np.full((1 << bits, 1 << bits), UNLIKE)
    for old, new in itertools.product(range(others), repeat=2):
        differences = np.unique(weights[:, :, new] - weights[:, :, old])
        if len(differences) == 1:
            of_any[old, new] = differences[0]
    begin = np.searchsorted([one.site[0] for one in ordered], range(states + 1))
    partner = [() if one.neighbour is None else one.neighbour[0] for one in ordered]
    every = range(z)
    return Rates(
        begin.astype(np.int64),
        first,
        bits,
        padded.ravel(),
        change.ravel(),
        of_any.ravel(),
        np.array(rates),
        np.array(shares).ravel(),
        np.array([sum(1 << b for b in some) for some in partner]),
        np.array([sum(1 << k for k in (one.directions or every)) for one in ordered]),
    )


def _rate_of(process: Process, counts: Counts) -> float:
    """The rate of a process with these neighbours. Raises CaseError for what is no rate."""
    name = f"lattice.model: rate of {show(process.name)}"
    try:
        rate = float(process.rate(counts) if callable(process.rate) else process.rate)
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise CaseError(f"{name}: {type(error).__name__}: {error}") from error
    if not 0 <= rate < math.inf:
        raise CaseError(f"{name} = {rate}: expected a finite number, at least 0")
    return rate


def _check_states(process: Process, states: int, others: int) -> None:
    """Raise CaseError for a process with a state that the model has not."""
    beside = [] if process.neighbour is None else [*process.neighbour[0], process.neighbour[1]]
    beside += [state for some in process.counted for state in some]
    if not all(0 <= state < states for state in process.site):
        raise CaseError(
            f"lattice.model: states {list(process.site)} of {show(process.name)}: expected "
            f"numbers from 0 to {states - 1}"
        )
    if not all(0 <= state <= others for state in beside):
        raise CaseError(
            f"lattice.model: states {beside} of neighbours of {show(process.name)}: expected "
            f"numbers from 0 to {others}"
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
    counts: Sequence[int], kinds: Sequence[tuple[int, int]], one: Process, others: int
) -> tuple[list[int], int]:
    """For a process: neighbours in each state, or in a group of states, and those that take part.

    counts: neighbours of each feature; kinds: a direction and a state with that feature.
    """
    found, partners = [0] * (others + 1), 0
    for (k, b), number in zip(kinds, counts, strict=True):
        for some in one.counted:
            found[some[0]] += number * (b in some)
        partners += number * one.takes(k, b)
    return found, partners


@number_alone.register(Table)
def _(model, state):
    return np.int64(model.of.first[U(state)])


@weight.register(Table)
def _(model, direction, state, other):
    return weight_in(model.of, direction, state, other if other >= 0 else model.number)


@change_of_weight.register(Table)
def _(model, direction, state, old, new):
    return weight_in(model.of, direction, state, new) - weight_in(model.of, direction, state, old)


@change_of_any.register(Table)
def _(model, old, new):
    return model.of.of_any[U((old << model.of.bits) | new)]


@change_of_own.register(Table)
def _(model, old, new):
    return model.of.own[U((old << model.of.bits) | new)]


@process_of.register(Table)
def _(model, sites, i, u):
    # the processes of this state, one after the other, until their rates make up u of all
    state, around = np.int64(sites.states[U(i)]), np.int64(sites.around[U(i)])
    left, row = u * model.of.rates[U(around)], around * len(model.new)
    last, chosen, target = np.int64(0), np.int64(-1), np.int64(-1)
    for p in range(model.of.begin[U(state)], model.of.begin[U(state + 1)]):
        rate = model.of.shares[U(row + p)]
        if rate > 0.0 and model.of.fits[U(p)] == 0:
            last, chosen, target, left = np.int64(p), np.int64(-1), np.int64(-1), left - rate
        elif rate > 0.0:
            fitting = np.uint64(0)  # a bit for each direction with a neighbour that takes part
            for direction in range(sites.grid.neighbours):
                j = neighbour(sites.grid, i, direction)
                there = np.int64(sites.states[U(j)]) if j >= 0 else model.number
                fits = (model.of.fits[U(p)] >> there) & (model.of.towards[U(p)] >> direction) & 1
                fitting |= U(fits) << U(direction)
            number = np.int64(bits_set(fitting))
            if number > 0:
                rank = min(np.int64(left / rate), number - 1)
                last, chosen = np.int64(p), np.int64(nth_bit(fitting, rank))
                target, left = neighbour(sites.grid, i, chosen), left - number * rate
        if left < 0.0:
            break
    return last, model.new[U(last)], chosen, target, model.beside[U(last)]
