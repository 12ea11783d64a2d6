"""A constant force on chosen beads."""

from __future__ import annotations

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Many
from mesokit.method.mpcd.solute.chosen import Chosen


@component
class Pull(Chosen):
    """A constant force on each of some beads, such as on one end of a chain.

    The two ends of an ideal chain of N beads with springs U = K r^2, pulled apart by f, are
    (N - 1) f/(2 K) from one another in the mean.

    >>> Pull([0.5, 0.0], bead=-1).force
    (0.5, 0.0)
    """

    force: Many[float] = param(
        doc="one number for each axis", symbol="F", unit="kT/a", min_length=2
    )
