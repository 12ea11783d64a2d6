"""Random deposition: atoms that stay where they come down."""

from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.heights import Growth, HeightModel
from mesokit.method.kinetic_monte_carlo.model.protocol import Known
from mesokit.method.kinetic_monte_carlo.model.table import Process
from mesokit.method.kinetic_monte_carlo.start import sites_of


@component
class RandomDeposition(HeightModel):
    """Columns that grow without regard to one another: the square of the width is the mean height.

    Source: A.-L. Barabasi and H. E. Stanley, Fractal Concepts in Surface Growth (1995), chapter 4.
    """

    rule: Literal["random-deposition"] = tag("random-deposition")
    flux: float = param(1.0, doc="atoms for each site", symbol="F", unit="1/time", gt=0)

    def growth(self, kind: Kind) -> list[Growth]:
        """Deposition anywhere."""
        return [Growth(Process("deposit", (0, 0), self.flux), 1)]

    def expected(self, case: Case) -> Mapping[str, Known]:
        """Speed and exponent of independent columns."""
        return {
            "speed of growth": (self.flux, "all atoms stay"),
            "growth exponent": (0.5, "independent columns"),
        }

    def expected_width(
        self, case: Case, time: NDArray[np.float64], first: float
    ) -> tuple[NDArray[np.float64] | None, str]:
        """The width of independent columns, about their own mean."""
        if not len(time):
            return None, ""
        grown = self.flux * (time - time[0]) * (1 - 1 / sites_of(case))
        return np.sqrt(first + grown), "independent columns, exact"
