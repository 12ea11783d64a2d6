"""Pictures from the observable flow-frames."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.flow_frames import weights
from mesokit.observe.result import Result
from mesokit.report.flow.data import Array, Flow
from mesokit.report.flow.setting import Setting

if TYPE_CHECKING:
    from mesokit.case import Case


class FrameSource:
    """The frames of one result."""

    def __init__(self, case: Case, result: Result) -> None:
        time, first, second, _ = result.x
        self.result, self.axes, self.time = result, (first, second), result.x[time]
        self.setting = Setting.of(case, self.axes)
        self.parts = list(result.x["component"])
        self.samples = result.extra["samples"]
        self.whole = np.flatnonzero(self.samples == self.samples.max(initial=0))
        particles = {"particles"} if result.extra["positions"].shape[1] else set()
        self.gives = frozenset({"velocity", "density"} | particles)

    @cached_property
    def weights(self) -> Array:
        """Of the velocities: the mass in each bin."""
        return weights(self.result)

    def flow(self, frames: NDArray[np.int64]) -> Flow:
        """Means over some frames: momentum over mass."""
        value, weight = self.result.value[frames], self.weights[frames]
        components = [self.parts.index(f"velocity_{axis}") for axis in self.axes]
        momentum = np.nan_to_num(value[..., components]) * weight[..., None]
        with np.errstate(invalid="ignore", divide="ignore"):
            velocity = momentum.sum(axis=0) / weight.sum(axis=0)[..., None]
        density = np.average(
            value[..., self.parts.index("density")], axis=0, weights=self.samples[frames]
        )
        positions = self.result.extra["positions"][frames[-1]]
        return self.setting.flow(
            density=density,
            velocity=velocity,
            particles=positions[:, self.setting.columns] if positions.size else None,
        )
