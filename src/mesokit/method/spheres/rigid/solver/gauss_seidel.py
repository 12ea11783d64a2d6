"""One contact after another, each with the latest impulses of the others."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.rigid.solver.protocol import (
    COLOURED,
    ORDERED,
    RANDOM,
    ContactSolver,
    Sweeping,
)
from mesokit.theory.sweeps import Order

ORDERS = {"coloured": COLOURED, "ordered": ORDERED, "random": RANDOM}


@component
class GaussSeidel(ContactSolver):
    """Contacts one by one (Jean 1999), to the same bits on any number of threads.

    Random orders spread impulses evenly in all directions (Unger and Kertész 2003). Contacts of one
    colour have no grain in common, so threads share them; the other orders have one thread.

    >>> GaussSeidel("random", sweeps=100).sweeps
    100
    """

    rule: Literal["gauss-seidel"] = tag("gauss-seidel")
    order: Literal["coloured", "ordered", "random"] = param(
        "coloured",
        doc="'coloured': colour after colour; 'ordered': by the numbers of the grains; 'random': "
        "drawn anew for every sweep",
    )

    @property
    def shared(self) -> bool:
        return self.order == "coloured"

    @property
    def spreads(self) -> Order:
        return self.order

    def kernel(self) -> Sweeping:
        return Sweeping(ORDERS[self.order], self.sweeps, self.tolerance, 1.0)
