"""External forces on beads of solutes, all or some of them."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, option, param, show
from mesokit.case.describe.hints import Many
from mesokit.errors import CaseError


@component
class Chosen:
    """Beads of one kind of solute: all of them, or one of each molecule."""

    kind: int | str = option(default=1, doc="of solute, by name or number from 1", kw_only=True)
    bead: int | None = option(
        default=None,
        doc="of each molecule: 1 the first, -1 the last (all unless said)",
        kw_only=True,
    )

    def beads(self, solutes: Any) -> NDArray[np.int64]:
        """Their numbers from 0. Raises CaseError for a kind or a bead that is not there."""
        kind = solutes.index_of(self.kind)
        polymer, first = solutes.polymers[kind], solutes.first_bead(kind)
        every = first + np.arange(polymer.number * polymer.length).reshape(-1, polymer.length)
        if self.bead is None:
            return every.ravel()
        if not 1 <= abs(self.bead) <= polymer.length:
            raise CaseError(
                f"bead = {show(self.bead)}: expected 1 to {polymer.length}, or -1 to "
                f"-{polymer.length} from the end"
            )
        return every[:, self.bead - (self.bead > 0)]


@component
class Trap(Chosen):
    """U = k/2 |r - centre|^2 for each of some beads, r counted as if the box had no bounds.

    A bead alone in it is at a mean square distance of d kT/k from the centre.

    >>> Trap([8.0, 8.0], k=2.0).k
    2.0
    """

    centre: Many[float] = param(doc="one number for each axis", unit="a", min_length=2)
    k: float = param(1.0, doc="U = k/2 |r - centre|^2", unit="kT/a^2", gt=0, le=1e9)


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
