"""Base class of observables of flocks, and what they read of an engine."""

from abc import ABC
from typing import ClassVar, Protocol

from mesokit.case.case import Case
from mesokit.case.component import component, name_of
from mesokit.errors import CaseError
from mesokit.seam.engine import Array, Particles
from mesokit.seam.observable import Observable


@component
class FlockObservable(Observable, ABC):
    """Something measured of birds."""

    needs_fluid: ClassVar[bool] = False
    among_walls: ClassVar[bool] = True  # whether the mean density may be uneven

    def check(self, case: Case) -> None:
        """Raise CaseError for a case without birds, and for walls that make the density uneven."""
        if not hasattr(case, "flock"):
            raise CaseError("there are no birds; it is for method 'flock'")
        if case.walls and not self.among_walls:
            raise CaseError(
                f"quantity = '{name_of(self)}': not among walls, which make the mean density uneven"
            )


class RunningFlock(Particles, Protocol):
    """Readings of an engine of birds: unit vectors (n, d) along which they head."""

    def headings(self) -> Array: ...
