"""Random deposition: atoms that stay where they come down."""

from typing import Literal

from mesokit.case.component import component, param, tag
from mesokit.method.kinetic_monte_carlo.lattice.kinds import Kind
from mesokit.method.kinetic_monte_carlo.model.heights import Growth, HeightModel
from mesokit.method.kinetic_monte_carlo.model.table import Process


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
