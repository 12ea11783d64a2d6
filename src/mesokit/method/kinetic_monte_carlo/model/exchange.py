"""Exchange of the states of two neighbours, which keeps how many sites have each (Kawasaki 1966)."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.errors import CaseError
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.protocol import (
    Energies,
    change_of_own,
    change_of_weight,
    number_alone,
    weight,
)
from mesokit.method.kinetic_monte_carlo.model.table import Counts, Process, Rates, Table, rates_of

MOST = 2**8  # kinds of surroundings of a site: of two sites there are as many squared
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


for _function in (number_alone, weight, change_of_weight, change_of_own):
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
    there = [(k, *known[int(which) - 1]) for k, which in enumerate(of.rates) if which > 0]
    for (k, a, around), (m, b, other) in itertools.product(there, repeat=2):
        # each is among the neighbours of the other, before and after
        if a != b and around[b] > 0 and other[a] > 0:
            change = _of_pair(energies, around, a, b) + _of_pair(energies, other, b, a)
            rates[k, m] = rate(change)
    return Exchanges(states, of._replace(rates=of.rates[:0]), numbers, rates.ravel())


def _of_pair(energies: Energies, around: Sequence[int], old: int, new: int) -> float:
    """What the energy with all neighbours but the other one changes by."""
    pairs = np.array(around[: len(energies.site)], float)
    pairs[new] -= 1
    return float(pairs @ (energies.pair[new] - energies.pair[old]))
