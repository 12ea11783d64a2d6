"""Protocol of histories of shear: the shear rate at a time, and the strain since time 0.

Time counts from the start of a run, its warm-up included. The kernel of a history is a NamedTuple
of numbers, whose class picks the two scalar functions. A kernel is made for a height: the rate
times the height is the speed at that height, the strain times the height the displacement.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.scalar.jit import generic


@family("history of shear", "rule", "mesokit.shear")
@component
class ShearHistory(ABC):
    """How the shear rate changes in time."""

    steady: ClassVar[bool] = False  # whether the rate is the same at all times

    @property
    def repeats_after(self) -> float | None:
        """The time after which the rates are those from time 0 again; None if they never are."""
        return None

    @property
    @abstractmethod
    def largest(self) -> float:
        """Largest size of the shear rate."""

    @abstractmethod
    def kernel(self, height: float) -> Any:
        """Parameters for the scalar functions below: a NamedTuple, whose class picks them."""

    def problems(self) -> Iterator[str]:
        """Errors, key first."""
        yield from ()

    def rate_at(self, time: float) -> float:
        """Shear rate at a time."""
        return float(speed(self.kernel(1.0), float(time)))

    def strain_at(self, time: ArrayLike) -> NDArray[np.float64]:
        """Strain since time 0 at times of any shape."""
        kernel, times = self.kernel(1.0), np.asarray(time, dtype=float)
        found = [slid(kernel, t) for t in times.ravel().tolist()]
        return np.array(found, dtype=float).reshape(times.shape)


@generic
def speed(history, time):
    """Speed at the height of the kernel: the shear rate times that height."""


@generic
def slid(history, time):
    """Displacement at that height since time 0: the integral of the speed, exactly."""
