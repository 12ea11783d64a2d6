"""Protocol of potentials: energy and force, both from one place.

The first argument is the potential's NamedTuple of parameters; its class picks the implementation.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from mesokit import theory
from mesokit.case.component import component
from mesokit.case.registry import family
from mesokit.scalar.jit import generic


@family("bond", "rule", "mesokit.potential")
@component
class Bond(ABC):
    """Potential of a bond between two beads: `central` and `breaks` below."""

    @property
    @abstractmethod
    def longest(self) -> float:
        """Length that the bond cannot reach, infinite if there is none."""

    @abstractmethod
    def kernel(self) -> Any:
        """Parameters for the scalar functions below."""

    def spring(self) -> theory.Spring | None:
        """The spring without a length of its own that it is, for theory; None for others."""
        return None


@family(
    "pair potential", "rule", "mesokit.potential", "Table.from_function makes a potential of one"
)
@component
class Pair(ABC):
    """Potential between any two beads, or a bead and a wall: `central` below."""

    @property
    @abstractmethod
    def reach(self) -> float:
        """Distance beyond which there is no force."""

    @property
    @abstractmethod
    def diameter(self) -> float:
        """How large a bead is: hardly any two come nearer."""

    @abstractmethod
    def kernel(self) -> Any:
        """Parameters for the scalar functions below."""

    def mixed(self, other: Pair) -> Pair | None:
        """Potential of beads of this and of another potential; None without a rule."""
        return None


@family("angle potential", "rule", "mesokit.potential")
@component
class Angle(ABC):
    """Potential of the angle between two bonds in a row: `angular` below."""

    @property
    @abstractmethod
    def stiffness(self) -> float:
        """Second derivative by the angle of a straight chain."""

    @abstractmethod
    def kernel(self) -> Any:
        """Parameters for the scalar functions below."""


@generic
def central(potential, square):
    """Energy of two beads whose squared distance is given, and their push.

    The push times the vector from one bead to the other is the force on the other: minus the
    derivative of the energy over the distance.
    """


@generic
def breaks(potential, square):
    """Whether a bond of this squared length is longer than it can be (a literal where none is)."""


breaks.otherwise(lambda potential, square: False)


@generic
def angular(potential, cosine):
    """Energy of two bonds in a row, the cosine of whose angle is given (1: straight), and its
    derivative by the cosine."""
