"""Base of the solvers of contact forces, and what the loops know of them."""

from abc import ABC, abstractmethod
from typing import ClassVar, NamedTuple

from mesokit.case.component import component, param
from mesokit.case.registry import family
from mesokit.theory.sweeps import Order

COLOURED, ORDERED, RANDOM, TOGETHER = range(4)  # orders of contacts within a sweep


class Sweeping(NamedTuple):
    """A solver for the loops: order of contacts, most sweeps in a step, relative change of impulses
    at which they end, and by how much of their change impulses change."""

    order: int
    sweeps: int
    tolerance: float
    relaxation: float


@family("solver of contacts", "rule", "mesokit.contact_solver")
@component
class ContactSolver(ABC):
    """Sweeps over all contacts, which change the impulse of each to what its law asks for.

    Each step begins with the impulses of the last one. The sweeps end when the largest change of an
    impulse is below `tolerance` times the mean impulse, or after `sweeps`.
    """

    rolls: ClassVar[bool] = True  # whether it has friction against rolling

    sweeps: int = param(500, doc="most sweeps in a step", ge=1, le=10**7, kw_only=True)
    tolerance: float = param(
        1e-4,
        doc="sweeps end where no impulse changes by more of the mean than this (0: never)",
        ge=0,
        le=1,
        kw_only=True,
    )

    @property
    def shared(self) -> bool:
        """Whether threads share the contacts."""
        return True

    @property
    def settles(self) -> bool:
        """Whether errors decay in dense packings."""
        return True

    @property
    @abstractmethod
    def spreads(self) -> Order:
        """The order of updates by which forces spread (`theory.sweep_spread`)."""

    @abstractmethod
    def kernel(self) -> Sweeping:
        """Parameters of the loops."""
