"""What observers of the walls share: when the surfaces' momentum is counted, and for whom."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mesokit.case.component import name_of
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import slit_of

if TYPE_CHECKING:
    from mesokit.case.case import Case


def require_counted(case: Case, quantity: str) -> None:
    """Raise CaseError where it is not counted, or for a second observer: reading it starts anew."""
    if slit_of(case) is not None and case.walls[0].virtual == "top-up":
        raise CaseError(
            f"{quantity} is not counted with virtual = 'top-up' in a slit; use 'extrapolate'"
        )
    readers = [name_of(other) for other in case.observe if "walls" in other.measures]
    if len(readers) > 1:
        kinds = " or ".join(dict.fromkeys(readers))
        raise CaseError(f"expected one {kinds}: each reading starts the count anew")
