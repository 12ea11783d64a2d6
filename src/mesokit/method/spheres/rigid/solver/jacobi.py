"""All contacts at once, each with the old impulses of the others."""

from typing import ClassVar, Literal

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.rigid.solver.protocol import TOGETHER, ContactSolver, Sweeping
from mesokit.theory.parallel_update import largest_relaxation
from mesokit.theory.sweeps import Order


@component
class Jacobi(ContactSolver):
    """All impulses from the old ones of all others: unstable in all but loose packings.

    In a triangular lattice errors double with each sweep; a relaxation below 2/3 cures that (Unger
    and Kertész 2003). It shows why contacts are updated one by one.

    >>> Jacobi(relaxation=0.5).kernel().relaxation
    0.5
    """

    rolls: ClassVar[bool] = False

    rule: Literal["jacobi"] = tag("jacobi")
    relaxation: float = param(
        1.0, doc="part of its change by which an impulse changes in a sweep", gt=0, le=2
    )

    @property
    def settles(self) -> bool:
        return self.relaxation < largest_relaxation("fcc")

    @property
    def spreads(self) -> Order:
        return "jacobi"

    def kernel(self) -> Sweeping:
        return Sweeping(TOGETHER, self.sweeps, self.tolerance, self.relaxation)
