"""Colours of a picture: from where to where, which, and what they mean."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mesokit.report.flow.data import Array

ENOUGH = 99.5  # percent of the bins that the colours span; the few beyond are noise


@dataclass(frozen=True)
class Scale:
    """Colours (a name or a map of Matplotlib) from `low` to `high`, and what they show.

    `names`: of whole numbers from 0, each of which has a colour of its own. `logarithmic`: numbers
    below `low` have the colour of `low`.
    """

    low: float
    high: float
    colours: Any
    label: str
    names: tuple[str, ...] = ()
    logarithmic: bool = False

    def mappable(self) -> Any:
        """What Matplotlib draws a colour bar of."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import LogNorm, Normalize

        if self.logarithmic:
            return ScalarMappable(LogNorm(self.low, self.high, clip=True), self.colours)
        return ScalarMappable(Normalize(self.low, self.high), self.colours)


def reach_of(values: Array) -> float:
    """The size that nearly all of the values keep within, 1 where there are none or all are 0."""
    finite = abs(values[np.isfinite(values)])
    return float(np.percentile(finite, ENOUGH)) or 1.0 if len(finite) else 1.0
