"""Base of forces that change in time: another force times a factor.

The factor is that of the middle of a timestep, and kept for it: exact for what grows evenly with
time, second order in the timestep for all else. `field_at` brings it to a time before each step.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection, Iterator
from typing import Any, ClassVar, NamedTuple

from mesokit.case.component import component, name_of, param, show
from mesokit.method.mpcd.field.protocol import Force, acceleration, field_at
from mesokit.scalar.jit import by_type, generic
from mesokit.scalar.vector import scaled


@component
class Varying(Force):
    """A force times a factor that changes in time."""

    of: Force = param(doc="the force where the factor is 1")

    steady: ClassVar[bool] = False

    @property
    def most(self) -> float:
        """Largest size of the factor."""
        return 1.0

    @property
    def largest(self) -> float:
        return self.most * self.of.largest

    def largest_in(self, size: tuple[int, ...]) -> float:
        return self.most * self.of.largest_in(size)

    def vectors(self) -> dict[str, tuple[float, ...]]:
        return {f"of.{key}": value for key, value in self.of.vectors().items()}

    def axes(self) -> dict[str, str]:
        return {f"of.{key}": value for key, value in self.of.axes().items()}

    def problems(self, closed: Collection[str]) -> Iterator[str]:
        """Errors of the force; one that does not act or varies itself is an error too."""
        if not self.of.acts or isinstance(self.of, Varying):
            yield f"of.rule = {show(name_of(self.of))}: expected a force that acts, and is steady"
        yield from (f"of.{problem}" for problem in self.of.problems(closed))

    def misfits(self, size: tuple[int, ...]) -> Iterator[str]:
        yield from (f"of.{problem}" for problem in self.of.misfits(size))

    def notes(self, size: tuple[int, ...]) -> Iterator[str]:
        yield from (f"of.{note}" for note in self.of.notes(size))

    def drives(self, component: int) -> bool:
        for dimension in (3, 2):
            acceleration = self.of.uniform(dimension)
            if acceleration is not None and component < len(acceleration):
                return acceleration[component] != 0
        return self.of.drives(component)

    @abstractmethod
    def at(self, time: float) -> float:
        """The factor at a time."""

    @abstractmethod
    def change(self) -> Any:
        """Parameters for `factor` below: a NamedTuple, whose class picks it."""

    def kernel(self, size: tuple[int, ...]) -> Scaled:
        """Parameters for the scalar functions below; the factor is that of time 0."""
        return Scaled(self.of.kernel(size), self.change(), self.at(0.0))


class Scaled(NamedTuple):
    """A force, what its factor follows, and the factor of this step."""

    field: tuple
    change: tuple
    factor: float


@generic
def factor(change, time):
    """The factor at a time since the start of the warm-up."""


acceleration.register(Scaled)(lambda field, r: times(field.factor, acceleration(field.field, r)))


@by_type
def times(share, a):
    """A vector times a number; no vector stays none."""
    if len(a) == 0:
        return lambda share, a: a
    return lambda share, a: scaled(share, a)


@field_at.register(Scaled)
def _(field, time):
    return Scaled(field.field, field.change, factor(field.change, time))
