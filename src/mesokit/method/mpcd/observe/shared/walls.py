"""What observers of the walls share: when the surfaces' momentum is counted, and how it is read."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mesokit.case.case import Case
from mesokit.errors import CaseError
from mesokit.geometry.solids.solids import slit_of
from mesokit.seam.engine import RunningFluid
from mesokit.seam.observable import State
from mesokit.statistics import Tally


def require_counted(case: Case, quantity: str) -> None:
    """Raise CaseError where the momentum that walls take is not counted."""
    if slit_of(case) is not None and case.walls[0].virtual == "top-up":
        raise CaseError(
            f"{quantity} is not counted with virtual = 'top-up' in a slit; use 'extrapolate'"
        )


class SinceLast:
    """What surfaces (rows, columns) took between one sample and the next."""

    def __init__(self, rows: int, columns: int) -> None:
        self.shape, self.steps = (rows, columns), 0
        self.last = Tally((rows * columns,), 1.0)

    def take(self, fluid: RunningFluid) -> tuple[NDArray[np.float64], int]:
        """Momentum and angular momentum of each, and in how many steps."""
        now, steps = fluid.wall_tally, fluid.wall_steps - self.steps
        taken = now.since(self.last).reshape(self.shape)
        self.last, self.steps = now.copy(), fluid.wall_steps
        return taken, steps

    def state(self) -> State:
        """What was read last."""
        return self.last.state() | {"steps": np.array(self.steps)}

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.last.restore(state)
        self.steps = int(state["steps"])
