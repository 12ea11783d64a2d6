"""How long spheres remember their velocity, where no theory knows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mesokit.errors import CaseError
from mesokit.geometry.walls import closed_axes

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.seam.engine import Array, Integers


class VelocityMemory:
    """Along the axes without a wall at their ends and without gravity.

    Raises CaseError without such an axis.
    """

    answers = "velocity-autocorrelation"

    def __init__(self, case: Case, observable: Any) -> None:
        shut, pull = closed_axes(case), case.spheres.gravity or (0.0,) * case.box.dimension
        self.axes = tuple(k for k, g in enumerate(pull) if k not in shut and g == 0)
        if not self.axes:
            raise CaseError("velocity-autocorrelation: every axis has gravity or a wall")

    def expected(self, steps: Integers) -> Array | None:
        """Nothing."""
        return None

    def legend(self) -> str:
        """There is no theory to name."""
        return ""

    def level(self, error: float, runs: int) -> tuple[float, float] | None:
        """Not known."""
        return math.nan, error

    def share(self, every: int) -> str | None:
        """Not told."""
        return None

    def diffusion(self, every: int) -> tuple[float, str] | None:
        """Not known."""
        return math.nan, ""

    def tail(self, time: Array) -> Array | None:
        """None."""
        return None

    def crossing(self) -> float:
        """There is no tail."""
        return math.inf
