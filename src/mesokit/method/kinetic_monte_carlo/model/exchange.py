"""Exchange of the states of two neighbours, which keeps the number of each (Kawasaki 1966)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.lattice.patch import Patch
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    Energies,
    Move,
    Moves,
    change_of_any,
    change_of_own,
    change_of_weight,
    number_alone,
    weight,
)
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, Rates, Table, rates_of

MOST = 2**10  # kinds of surroundings of a site: of two sites there are as many squared
NAME = "exchange"


class Exchanges(NamedTuple):
    """Exchanges as kernels take them.

    number: states a site may have. of: surroundings of a site. numbers: how many of these there
    are. rates: (numbers^2,) of an exchange, by those of both.
    """

    number: int
    of: Rates
    numbers: int
    rates: NDArray[np.float64]


for _function in (number_alone, weight, change_of_weight, change_of_any, change_of_own):
    _function.register(Exchanges)(_function.implementation(Table))


def exchanges(
    energies: Energies, rate: Callable[[float], float], kind: Kind, ends: bool
) -> Exchanges:
    """All exchanges of unlike neighbours, at the rate that the change of energy gives."""
    states = len(energies.site)
    known: list[tuple[int, Counts]] = []  # state and numbers of neighbours in each state

    def note(state: int) -> Callable[[Counts], float]:
        def one(counts: Counts) -> float:
            known.append((state, tuple(counts)))
            return float(len(known))

        return one

    every = tuple((b,) for b in range(states))
    table = [Process(str(s), (s, s), note(s), every) for s in range(states)]
    of = rates_of(table, states, states, kind, ends)
    numbers = len(of.rates)
    if numbers > MOST:
        raise CaseError(
            f"lattice.model: {numbers} kinds of surroundings of a site; expected at most {MOST} "
            "for exchanges"
        )
    rates = np.zeros((numbers, numbers))
    for a, b in itertools.permutations(range(states), 2):
        one, around = _beside(of, known, a, b)
        two, other = _beside(of, known, b, a)
        changes = _of_site(energies, around, a, b)[:, None] + _of_site(energies, other, b, a)
        different, which = np.unique(changes, return_inverse=True)
        rates[np.ix_(one, two)] = np.array([rate(float(c)) for c in different])[which].reshape(
            changes.shape
        )
    return Exchanges(states, of._replace(rates=of.rates[:0]), numbers, rates.ravel())


def _beside(
    of: Rates, known: Sequence[tuple[int, Counts]], state: int, other: int
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Surroundings of sites in a state with a neighbour in another, and the numbers of neighbours
    in each state but for that one: (m,) and (m, states)."""
    found = [
        (k, counts)
        for k, which in enumerate(of.rates)
        if which > 0 and known[int(which) - 1][0] == state
        for counts in [np.array(known[int(which) - 1][1][:-1], float)]
        if counts[other] > 0
    ]
    numbers = np.array([k for k, _ in found], np.int64)
    rest = np.array([counts for _, counts in found]).reshape(len(found), -1)
    rest[:, other] -= 1
    return numbers, rest


def _of_site(
    energies: Energies, rest: NDArray[np.float64], old: int, new: int
) -> NDArray[np.float64]:
    """What the energy of a site with these neighbours changes by when its state changes."""
    scale = float(np.abs(energies.pair).max()) or 1.0
    # rounded, since sums in another order would make other rates
    return scale * np.round(rest @ (energies.pair[new] - energies.pair[old]) / scale, 12)


def exchange_moves(energies: Energies, rate: Callable[[float], float]) -> Moves:
    """The same in plain Python: each pair of neighbours once, from the site that comes first."""
    states = len(energies.site)

    def counts(patch: Patch, i: int) -> list[int]:
        around = patch.around(i, states)
        return [around.count(state) for state in range(states)]

    def at(patch: Patch, i: int) -> Iterator[Move]:
        for j in patch.near[i]:
            a, b = patch.states[i], patch.states[j]
            if j > i and a != b:
                change = _of_pair(energies, counts(patch, i), a, b)
                change += _of_pair(energies, counts(patch, j), b, a)
                yield Move(NAME, rate(change), ((i, b), (j, a)))

    return Moves(at, reach=2)


def _of_pair(energies: Energies, around: Sequence[int], old: int, new: int) -> float:
    """What the energy with all neighbours but the other one changes by."""
    pairs = np.array(around[: len(energies.site)], float)
    pairs[new] -= 1
    return float(pairs @ (energies.pair[new] - energies.pair[old]))
