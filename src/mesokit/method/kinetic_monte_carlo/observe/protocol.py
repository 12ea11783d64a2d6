"""Base class of observables of lattices, and what they read of an engine."""

from abc import ABC
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component
from mesokit.errors import CaseError
from mesokit.seam.engine import Sites
from mesokit.seam.observable import Observable


@component
class LatticeObservable(Observable, ABC):
    """Something measured of the sites of a lattice."""

    needs_fluid: ClassVar[bool] = False

    def check(self, case: Case) -> None:
        """Raise CaseError for a case without a lattice."""
        if not hasattr(case, "lattice"):
            raise CaseError("there is no lattice; it is for method 'kinetic-monte-carlo'")


class RunningLattice(Sites, Protocol):
    """Readings of an engine of a lattice (see `engine/engine.py`)."""

    n: int

    def pairs(self) -> NDArray[np.int64]: ...
    def happened(self) -> NDArray[np.int64]: ...
    def began(self) -> NDArray[np.integer]: ...
    def tracers(self, ids: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]: ...
    def waits(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]: ...
    def waiting(self) -> NDArray[np.float64]: ...
