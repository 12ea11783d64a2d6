"""Pictures from maps: of a velocity, whose results have components, or of a density."""

import numpy as np
from numpy.typing import NDArray

from mesokit.report.flow.data import Flow
from mesokit.report.flow.setting import Setting
from mesokit.seam.result import Result


class FieldSource:
    """One map, the mean over the whole run."""

    def __init__(self, setting: Setting, result: Result) -> None:
        self.setting, self.result, self.axes = setting, result, setting.axes
        self.gives = frozenset({"velocity" if "component" in result.x else "density"})
        self.time = np.zeros(0)
        self.whole = np.zeros(0, np.int64)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """The map."""
        result = self.result
        turned = next(iter(result.x)) != self.axes[0]
        value, error = (a.swapaxes(0, 1) if turned else a for a in (result.value, result.error))
        if "density" in self.gives:
            return self.setting.flow(density=value)
        components = list(result.x["component"])
        use = [components.index(axis) for axis in self.axes]
        error = error[..., use]
        noise = np.random.default_rng(0).normal(size=error.shape) * error
        known = np.isfinite(error).any()
        return self.setting.flow(
            velocity=value[..., use], error=error, noise=noise if known else None
        )
