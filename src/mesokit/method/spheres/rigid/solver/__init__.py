"""How the impulses of all contacts are found. A new solver is a file here."""

from mesokit.case.registry import parts_in
from mesokit.method.spheres.rigid.solver.protocol import ContactSolver

__getattr__ = parts_in(__name__, SOLVERS=ContactSolver)

__all__ = ["SOLVERS", "ContactSolver"]
