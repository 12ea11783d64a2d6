"""Seam of models: what may happen at a site, how often, and what it changes.

The first argument of the scalar functions is the model's NamedTuple of parameters; its class picks
the implementation. `sites` are `mesokit.method.kinetic_monte_carlo.lattice.grid.Sites`.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.lattice.patch import Patch
from mesokit.scalar.jit import generic
from mesokit.seam.method import Row

Known = tuple[float, str]  # a number and a note on its theory

UNLIKE = -(2**40)
MISSING = -(2**31)  # in place of the state of a neighbour, beyond the end of a lattice


class Energies(NamedTuple):
    """Energy of a site in each state (s,), and of two neighbours in each pair of states (s, s).

    They are in units of kT if the model has no `kT`.
    """

    site: NDArray[np.float64]
    pair: NDArray[np.float64]


class Move(NamedTuple):
    """One thing that may happen: its name, its rate, and the sites that change to new states."""

    name: str
    rate: float
    changes: tuple[tuple[int, int], ...]


def over_pairs(patch: Patch, energy: Callable[[int, int], float]) -> float:
    """Sum of the energies of all pairs of neighbours."""
    return 0.5 * sum(  # each from both ends
        energy(patch.states[i], patch.states[j])
        for i, near in enumerate(patch.near)
        for j in near
        if j >= 0
    )


class Moves(NamedTuple):
    """What may happen at a site of a patch, as a function; and how far states matter for its rates,
    in steps from neighbour to neighbour."""

    at: Callable[[Patch, int], Iterator[Move]]
    reach: int = 1


@family("model of a lattice", "rule", "mesokit.lattice_model")
@component
class Model(ABC):
    """What may happen at the sites of a lattice."""

    @abstractmethod
    def states(self) -> tuple[str, ...]:
        """Names of the states of a site, by their numbers; none where these are heights."""

    @abstractmethod
    def kernel(self, kind: Kind, ends: bool) -> Any:
        """Parameters for the scalar functions below; `ends`: whether neighbours may be missing.

        Its field `rates` (m,) is the rate of all that may happen at a site, by surroundings.
        """

    @abstractmethod
    def events(self) -> Sequence[str]:
        """Names of what may happen, by the number that `process_of` gives."""

    def check(self, case: Case) -> None:  # noqa: B027  # most fit any lattice
        """Raise CaseError for a case in which the model has no meaning."""

    def energies(self) -> Energies | None:
        """Energies of sites and of pairs of neighbours; None where there is no energy."""
        return None

    def energy(self) -> Callable[[Patch], float] | None:
        """Energy as a function of a patch; None where there is no energy."""
        found = self.energies()
        if found is None:
            return None
        site, pair = found.site.tolist(), found.pair.tolist()
        return lambda patch: (
            sum(site[a] for a in patch.states) + over_pairs(patch, lambda a, b: pair[a][b])
        )

    def list_moves(self, kind: Kind) -> Moves | None:
        """All that may happen, in plain Python, for checks; None if it cannot be listed."""
        return None

    def derived(self, case: Case) -> Sequence[Row]:
        """Rows of `mesokit check`: numbers that follow from the keys of the model."""
        return ()

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Means that theory predicts, by name; nothing unless a model has formulas.

        "energy" and "square energy" of a site; "mean", "size", "square" and "fourth" of the mean
        spin; "part S" of the sites in state S; "rate of P", events of process P for each site;
        "speed of growth" of the mean height, "growth exponent" of the width of a surface;
        "correlation length" in sites.
        """
        return {}

    def expected_width(
        self, case: Case, time: NDArray[np.float64], first: float
    ) -> tuple[NDArray[np.float64] | None, str]:
        """Width of a surface at times, and a note; `first` is the square of the first width."""
        return None, ""


@generic
def number_alone(model, state):
    """The number of the surroundings of a site in a state that has no neighbours."""


@generic
def weight(model, direction, state, other):
    """What the neighbour in a direction adds to that number, by its state; MISSING: there is none.

    The rates of a site depend on its surroundings through this number alone.
    """


@generic
def change_of_weight(model, direction, state, old, new):
    """What that number changes by when a neighbour's state changes."""


@generic
def change_of_any(model, old, new):
    """The same for all directions and states; UNLIKE where it depends on them."""


@generic
def change_of_own(model, old, new):
    """What that number changes by when the site's own state changes, the same whatever is around
    it; UNLIKE: it must be found anew."""


@generic
def process_of(model, sites, i, u):
    """One of the processes that may happen at a site, drawn by a number u uniform in [0, 1).

    Its number; the new state of the site; of a process with a neighbour its direction, its place in
    memory (-1 where there is none) and its new state.
    """
