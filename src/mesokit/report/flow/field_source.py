"""Pictures from the observables velocity-field and density-field."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.result import Result
from mesokit.report.flow.data import Flow
from mesokit.report.flow.setting import Setting

if TYPE_CHECKING:
    from mesokit.case import Case


class FieldSource:
    """One map, the mean over the whole run."""

    def __init__(self, case: Case, result: Result) -> None:
        first, second = list(result.x)[:2]
        self.result, self.axes = result, (first, second)
        self.setting = Setting.of(case, self.axes)
        self.gives = frozenset({result.quantity.removesuffix("-field")})
        self.time = np.zeros(0)
        self.whole = np.zeros(0, np.int64)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """The map."""
        if "density" in self.gives:
            return self.setting.flow(density=self.result.value)
        components = list(self.result.x["component"])
        use = [components.index(axis) for axis in self.axes]
        return self.setting.flow(velocity=self.result.value[..., use])
