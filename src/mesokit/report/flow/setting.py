"""What all pictures of a case over two axes share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from mesokit.report.flow.data import Array, Flow
from mesokit.report.flow.solids import Section

if TYPE_CHECKING:
    from mesokit.case import Case


@dataclass(frozen=True)
class Setting:
    """Two axes of a box, their numbers `columns`, and whether each is periodic."""

    axes: tuple[str, str]
    columns: list[int]
    size: tuple[float, float]
    dimension: int
    periodic: tuple[bool, bool]

    @classmethod
    def of(cls, case: Case, axes: tuple[str, str]) -> Setting:
        """That of a case. Images along y move under shear: flow does not go on across them."""
        section = Section(case, axes)
        first, second = (
            not closed and not (case.box.shear_rate and axis == "y")
            for closed, axis in zip(section.closed(), axes, strict=True)
        )
        size = [float(case.box.size[column]) for column in section.columns]
        return cls(axes, section.columns, (size[0], size[1]), case.box.dimension, (first, second))

    def flow(
        self,
        density: Array | None = None,
        velocity: Array | None = None,
        particles: Array | None = None,
    ) -> Flow:
        """A flow over these axes."""
        return Flow(
            self.axes, self.size, self.dimension, self.periodic, density, velocity, particles
        )
