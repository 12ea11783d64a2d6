"""Pictures of a simulation in memory, as it is now: before its first step, where it starts from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from mesokit.case.trajectory import masses_and_kinds

if TYPE_CHECKING:
    from mesokit.case.case import Case
    from mesokit.engine import Particles

MOST = 20_000  # particles of the first group, evenly picked where there are more


class State:
    """One frame of the particles that an engine has, with what a `TrajectoryReader` tells."""

    fields = ("position",)

    def __init__(self, case: Case, engine: Particles) -> None:
        number = case.particles
        shown = min(MOST, number)
        picked = np.arange(shown) * number // max(shown, 1)
        others = np.arange(number, sum(group.number for group in case.groups))
        masses, kinds = masses_and_kinds(case.groups)
        self.id = np.concatenate([picked, others])
        self.species = kinds[self.id]
        self.mass = masses[self.species]
        self.step, self.time = np.array([engine.step]), np.array([engine.time])
        self.engine = engine

    def __len__(self) -> int:
        return 1

    def __getitem__(self, index: int) -> dict[str, Any]:
        """The frame."""
        return {"position": self.engine.positions(self.id)}
