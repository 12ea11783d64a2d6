"""Which beads of the solutes an external force acts on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.component import component, option, show
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
