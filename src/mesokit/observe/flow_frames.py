"""Pictures of the flow in time: density and velocity on a grid, window after window."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.observe.shared.field import Array, Field
from mesokit.seam.engine import RunningFluid
from mesokit.seam.estimate import of_ratio
from mesokit.seam.observable import BlockAccumulator, State, accumulator_of
from mesokit.seam.result import Result
from mesokit.statistics import spread_ids

MOST_NUMBERS = 2**27  # of all frames together: half a gigabyte


@component
class FlowFrames(Field):
    """Density and mean velocity on a grid over two axes, averaged over one window after another.

    What films and pictures of a part of a run are made of. A frame also has where some particles
    were at the first sample of its window. The last frame may be of a window cut short.

    >>> from mesokit import Box, FlowFrames, Run, Simulation
    >>> simulation = Simulation(run=Run(steps=50), box=Box([8, 6]), observe=[FlowFrames(window=20)])
    >>> simulation.run()
    >>> frames = simulation["flow-frames"]
    >>> frames.value.shape, frames.x["component"].tolist()
    ((3, 8, 6, 3), ['density', 'velocity_x', 'velocity_y'])
    """

    quantity: Literal["flow-frames"] = tag("flow-frames")
    drawing, value_label = "frames", "flow"
    window: int = param(100, doc="steps that one frame averages over", unit="steps", ge=1)
    particles: int = param(2000, doc="particles whose positions are kept", ge=0)

    def check(self, case: Case) -> None:
        """Raise CaseError for wrong axes, part of a sample in a window, or too many numbers."""
        super().check(case)
        if self.window % self.every:
            up = (self.window // self.every + 1) * self.every
            raise CaseError(
                f"window = {self.window}: expected a multiple of every = {self.every}, such as {up}"
            )
        numbers = self.numbers(case)
        if numbers > MOST_NUMBERS:
            raise CaseError(
                f"window = {self.window}: {self.frames(case)} frames are {numbers} numbers "
                f"({4 * numbers / 1e9:.2g} GB); expected at most {MOST_NUMBERS}: raise window, or "
                "lower bins_per_cell or particles"
            )

    def frames(self, case: Case) -> int:
        """Frames of a whole run."""
        return -(-case.run.steps // self.window)

    def numbers(self, case: Case) -> int:
        """Numbers kept of a whole run."""
        lengths = [case.box.size[case.box.index(axis)] for axis in self.axes]
        bins = lengths[0] * lengths[1] * self.bins_per_cell**2
        positions = min(self.particles, case.particles) * case.box.dimension
        return self.frames(case) * (bins * len(_parts(case)) + positions)

    def warnings(self, case: Case) -> Iterator[str]:
        """A window that is longer than the run."""
        if self.window > case.run.steps:
            yield (
                f"window = {self.window}: more than run.steps = {case.run.steps}; there will be "
                "one frame, of a window cut short"
            )


def _parts(case: Case) -> list[str]:
    """Numbers of each bin. Velocities are weighted by mass, which a mixture has apart."""
    mixture = case.fluid.mixed
    velocities = [f"velocity_{axis}" for axis in AXES[: case.box.dimension]]
    return ["density", *["mass_density"] * mixture, *velocities]


@accumulator_of(FlowFrames)
class FlowFramesAccumulator(BlockAccumulator):
    """All frames so far, and the sums of the one that is being filled."""

    def prepare(self) -> None:
        observable, box = self.observable, self.case.box
        self.axes = tuple(box.index(axis) for axis in observable.axes)
        self.bins = tuple(box.size[axis] * observable.bins_per_cell for axis in self.axes)
        self.parts = _parts(self.case)
        self.ids = spread_ids(observable.particles, self.case.particles)
        self.bin_volume = np.prod(box.size) / np.prod(self.bins)
        self.per_frame = observable.window // observable.every  # samples of a whole frame
        self.frames: list[NDArray[np.float32]] = []
        self.positions: list[NDArray[np.float32]] = []
        self.times: list[float] = []
        self.pooled = 1  # runs
        self._begin()

    def _begin(self) -> None:
        """Start a frame."""
        self.samples, self.time = 0, 0.0
        self.sums = np.zeros((2 + self.case.box.dimension, *self.bins))  # number, mass, momentum

    def observe(self, fluid: RunningFluid) -> None:
        if self.samples == 0:
            self.positions.append(fluid.positions(self.ids).astype(np.float32))
        number, mass, momentum, _ = fluid.moments(self.axes, self.bins)
        self.sums += np.concatenate([number[None], mass[None], momentum])
        self.time += fluid.time
        self.samples += 1
        if self.samples == self.per_frame:
            self.frames.append(self._frame())
            self.times.append(self.time / self.samples)
            self._begin()

    def _frame(self) -> NDArray[np.float32]:
        """Means of the frame that is being filled, (parts, *bins); nan for no velocity."""
        number, mass, momentum = self.sums[0], self.sums[1], self.sums[2:]
        with np.errstate(divide="ignore", invalid="ignore"):
            velocity = momentum / mass
        densities = self.sums[: len(self.parts) - len(momentum)] / self.samples / self.bin_volume
        velocity[:, number == 0] = np.nan
        return np.concatenate([densities, velocity]).astype(np.float32)

    def state(self) -> State:
        return {
            "frames": _stack(self.frames, (len(self.parts), *self.bins)),
            "positions": _stack(self.positions, (len(self.ids), self.case.box.dimension)),
            "times": np.array(self.times),
            "sums": self.sums.copy(),
            "samples": np.array(self.samples),
            "time": np.array(self.time),
        }

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        self.frames, self.positions = list(state["frames"]), list(state["positions"])
        self.times = [float(time) for time in state["times"]]
        self.sums = np.array(state["sums"])
        self.samples, self.time = int(state["samples"]), float(state["time"])

    def pool(self, other: Self) -> None:
        """Take in the samples of an independent run of the same case: only to read.

        Windows that both have seen whole become their means; particles stay those of the first.
        """
        shared = min(len(self.frames), len(other.frames))
        share, densities = 1 / (1 + self.pooled), len(self.parts) - self.case.box.dimension
        for i, frame in enumerate(other.frames[:shared]):
            own = self.frames[i]
            density = (1 - share) * own[:densities] + share * frame[:densities]
            mass = np.stack([(1 - share) * own[densities - 1], share * frame[densities - 1]])
            momentum = mass[:, None] * np.nan_to_num([own[densities:], frame[densities:]])
            with np.errstate(divide="ignore", invalid="ignore"):
                velocity = momentum.sum(axis=0) / mass.sum(axis=0)
            self.frames[i] = np.concatenate([density, velocity]).astype(np.float32)
        self.frames, self.times = self.frames[:shared], self.times[:shared]
        self.pooled += 1
        self._begin()

    def result(self) -> Result:
        """All frames, that of the unfinished window last."""
        frames, times = self.frames, self.times
        samples = [self.per_frame * self.pooled] * len(frames)
        if self.samples > 1 or (self.samples and not frames):  # one alone only begins a window
            frames, times = [*frames, self._frame()], [*times, self.time / self.samples]
            samples.append(self.samples)
        value = np.moveaxis(_stack(frames, (len(self.parts), *self.bins)), 1, -1)
        scale, density = self.observable.bins_per_cell, self.case.box.density_unit
        bins = zip(self.observable.axes, self.bins, strict=True)
        centres = {axis: (np.arange(n) + 0.5) / scale for axis, n in bins}
        units = {"time": "tau"} | dict.fromkeys(centres, "a") | {"density": density}
        units["mass_density"] = density.replace("1", "m")
        units |= {name: "a/tau" for name in self.parts if name.startswith("velocity")}
        positions = self.positions[: len(frames)]
        return self.report(
            {"time": times} | centres | {"component": self.parts},
            value.astype(float),
            units=units,
            samples=sum(samples),
            extra={
                "samples": np.array(samples, np.int64),
                "positions": _stack(positions, (len(self.ids), self.case.box.dimension)),
            },
        )


def _stack(arrays: list[NDArray[Any]], shape: tuple[int, ...]) -> NDArray[np.float32]:
    return np.stack(arrays) if arrays else np.zeros((0, *shape), np.float32)


def weights(result: Result) -> Array:
    """Weights of the velocities of flow-frames: mass in each bin (frames, *bins)."""
    parts = list(result.x["component"])
    kept = parts.index("mass_density") if "mass_density" in parts else parts.index("density")
    return result.value[..., kept] * result.extra["samples"][:, None, None]


def average(result: Result) -> Result:
    """The mean velocity over all frames, as the observable velocity-field gives it.

    Error bars come from the scatter of the frames: they are too small for frames much shorter than
    the memory of the flow.
    """
    _, first, second, _ = result.x
    use = [i for i, name in enumerate(result.x["component"]) if name.startswith("velocity")]
    mass = np.broadcast_to(weights(result)[..., None], (*result.value.shape[:-1], len(use)))
    momentum = np.nan_to_num(result.value[..., use]) * mass
    velocity = of_ratio(momentum, mass)
    return replace(
        result,
        quantity="velocity-field",
        drawing="map",
        x={
            first: result.x[first],
            second: result.x[second],
            "component": np.array([result.x["component"][i][-1] for i in use]),
        },
        value=velocity.value,
        error=velocity.error,
        label="velocity",
        units={"value": "a/tau", first: "a", second: "a"},
        extra={},
    )
