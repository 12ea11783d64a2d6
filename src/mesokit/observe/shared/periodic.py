"""Check of observables that need a box that repeats along every axis."""

from mesokit.case.case import Case
from mesokit.errors import CaseError

OF = "what is looked at (beads where there are any, those of solutes before those of molecules)"


def periodic_all_over(case: Case, what: str) -> None:
    """Raise CaseError for a box with sliding images, open ends or walls."""
    if case.box.sheared:
        raise CaseError(f"{what}: not under box.shear_rate, whose images slide")
    if case.walls:
        raise CaseError(f"{what}: not with walls; expected a box without any")
    if case.box.open:
        raise CaseError(f"{what}: not in an open box; expected a periodic one")
