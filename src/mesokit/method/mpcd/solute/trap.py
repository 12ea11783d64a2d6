"""A harmonic trap for chosen beads."""

from __future__ import annotations

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.solute.chosen import Chosen


@component
class Trap(Chosen):
    """U = k/2 |r - centre|^2 for each of some beads, r counted as if the box had no bounds.

    A bead alone in it is at a mean square distance of d kT/k from the centre.

    >>> Trap([8.0, 8.0], k=2.0).k
    2.0
    """

    centre: Many[float] = param(doc="one number for each axis", unit="a", min_length=2)
    k: float = param(1.0, doc="U = k/2 |r - centre|^2", unit="kT/a^2", gt=0, le=1e9)
