"""A magnetic field on charged beads that do not act on one another."""

from __future__ import annotations

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.solute.chosen import Chosen


@component
class MagneticField(Chosen):
    """Force q v x B on each of some beads; in 2D the field is along z.

    Velocities are turned by exactly q B t/m about the field (Boris 1970): it does no work. Between
    turns beads fly straight, in sub-steps short enough that each turn is small.

    >>> MagneticField([0.0, 0.0, 0.5], charge=2.0).charge
    2.0
    """

    field: Many[float] = param(
        doc="B: three numbers, in 2D too, where x and y are 0", min_length=3, max_length=3
    )
    charge: float = param(1.0, doc="of a bead; q B/m is the angular frequency", ge=-1e9, le=1e9)
