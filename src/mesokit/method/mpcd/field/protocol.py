"""Protocol of body forces: the acceleration at a place.

The first argument is the field's NamedTuple of parameters; its class picks the implementation. The
streaming step takes the acceleration at the middle of the straight flight and keeps it for the
timestep: exact for a uniform field, second order in the timestep for others.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection, Iterator
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.scalar.jit import generic

Array = NDArray[np.floating[Any]]


class Driven(NamedTuple):
    """The steady flow along one axis in a periodic box: its name, the axis across it, and the
    velocity by the coordinate there (None without a theory)."""

    kind: str
    across: int
    profile: Callable[[Array], Array] | None


class Swing(NamedTuple):
    """A force times cos(frequency t + phase): angular frequency, phase in radians."""

    of: Force
    frequency: float
    phase: float


@family("body force", "rule", "mesokit.field", "SampledForce.from_function makes a force of one")
@component
class Force(ABC):
    """Acceleration of the fluid and of all solutes."""

    acts: ClassVar[bool] = True
    steady: ClassVar[bool] = True  # whether it does not change in time
    gathers: ClassVar[bool] = True  # whether the density may be uneven for it, if it is not uniform

    @property
    @abstractmethod
    def largest(self) -> float:
        """Largest size of the acceleration."""

    def largest_in(self, size: tuple[int, ...]) -> float:
        """The same in a box of this size, if it depends on that."""
        return self.largest

    @abstractmethod
    def kernel(self, size: tuple[int, ...]) -> Any:
        """Parameters for the scalar function below, in a box of this size."""

    def uniform(self, dimension: int) -> tuple[float, ...] | None:
        """The acceleration, if it is the same everywhere."""
        return None

    def waves_across(self) -> int | None:
        """How many waves of it the box holds across the flow; None if it is no wave."""
        return None

    def vectors(self) -> dict[str, tuple[float, ...]]:
        """Its parameters that have one number for each axis, by key."""
        return {}

    def axes(self) -> dict[str, str]:
        """Its parameters that are axes of the box, by key."""
        return {}

    def problems(self, closed: Collection[str]) -> Iterator[str]:
        """The error where walls close these axes, key first; "" if there is none."""
        yield from ()

    def misfits(self, size: tuple[int, ...]) -> Iterator[str]:
        """The error in a box of this size, key first; "" if there is none."""
        yield from ()

    def notes(self, size: tuple[int, ...]) -> Iterator[str]:
        """Remarks on it in a box of this size, key first."""
        yield from ()

    def steady_flow(self, component: int, size: tuple[int, ...], viscosity: float | None) -> Driven:
        """The flow that it drives along one axis of a periodic box, if it is not uniform."""
        return Driven("driven", 1, None)

    def drives(self, component: int) -> bool:
        """Whether it acts along this axis, if it is not uniform."""
        return True

    def swing(self) -> Swing | None:
        """The cosine in time that it is; None for others."""
        return None

    def instability(self, reynolds: float, size: tuple[int, ...], across: int) -> str:
        """Why its flow breaks up at this Reynolds number, "" if it does not."""
        return ""


@generic
def acceleration(field, r):
    """Acceleration of a particle at r, or () for none."""


@generic
def field_at(field, time):
    """The field at a time since the start of the warm-up: the same, unless it changes."""


field_at.otherwise(lambda field, time: field)
