"""Pictures from maps: means of a whole run, or frames of the observable flow-frames."""

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mesokit.observe.flow_frames import weights
from mesokit.report.flow.data import Array, Flow
from mesokit.report.flow.setting import Setting
from mesokit.seam.result import Result


class FieldSource:
    """One map, the mean over a whole run: of a velocity, which has components, or of a density."""

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
        velocity, error = value[..., use], error[..., use]
        noise = np.random.default_rng(0).normal(size=error.shape) * error
        known = np.isfinite(error).any()
        return self.setting.flow(velocity=velocity, error=error, noise=noise if known else None)


class FrameSource:
    """The frames of one result."""

    def __init__(self, setting: Setting, result: Result) -> None:
        self.setting, self.result, self.axes = setting, result, setting.axes
        self.time = result.x["time"]
        self.turned = list(result.x)[1] != self.axes[0]
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
        if self.turned:
            value, weight = value.swapaxes(1, 2), weight.swapaxes(1, 2)
        components = [self.parts.index(f"velocity_{axis}") for axis in self.axes]
        velocity = _mean(value[..., components], weight)
        density = np.average(
            value[..., self.parts.index("density")], axis=0, weights=self.samples[frames]
        )
        positions = self.result.extra["positions"][frames[-1]]
        return self.setting.flow(
            density=density,
            velocity=velocity,
            particles=positions[:, self.setting.columns] if positions.size else None,
            noise=self._noise(frames, components),
        )

    def _noise(self, frames: NDArray[np.int64], components: list[int]) -> Array | None:
        """Half the difference of every other frame and those between; of a frame and the next."""
        alone = len(frames) == 1
        if alone:
            frames = frames[0] + np.arange(2) - (frames[0] + 1 == len(self.time))
        if frames[0] < 0:
            return None
        value, weight = self.result.value[frames][..., components], self.weights[frames]
        if self.turned:
            value, weight = value.swapaxes(1, 2), weight.swapaxes(1, 2)
        even, odd = (_mean(value[k::2], weight[k::2]) for k in range(2))
        noise: Array = (even - odd) / (np.sqrt(2) if alone else 2)
        return noise


def _mean(velocity: Array, weight: Array) -> Array:
    """Mean over frames, weighted; nan where a bin was empty all the time."""
    momentum = np.nan_to_num(velocity) * weight[..., None]
    with np.errstate(invalid="ignore", divide="ignore"):
        mean: Array = momentum.sum(axis=0) / weight.sum(axis=0)[..., None]
    return mean
