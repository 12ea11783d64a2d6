"""Seam of models: what may happen at a site, how often, and what it changes.

The first argument of the scalar functions is the model's NamedTuple of parameters; its class picks
the implementation. `sites` are `mesokit.method.kinetic_monte_carlo.lattice.grid.Sites`.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.scalar.jit import generic

UNLIKE = -(2**40)
MISSING = -(2**31)  # in place of the state of a neighbour, beyond the end of a lattice


class Energies(NamedTuple):
    """Energy of a site in each state (s,), and of two neighbours in each pair of states (s, s)."""

    site: NDArray[np.float64]
    pair: NDArray[np.float64]


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


@generic
def number_alone(model, state):
    """The number of the surroundings of a site in a state that has no neighbours."""


@generic
def weight(model, direction, state, other):
    """What the neighbour in a direction adds to that number, by its state; MISSING: there is none.

    The number tells all that the rates of what may happen at the site depend on.
    """


@generic
def change_of_weight(model, direction, state, old, new):
    """What that number changes by when a neighbour's state changes."""


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
