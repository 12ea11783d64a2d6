"""Mean square displacement of fluid particles, and their diffusion coefficient."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.box import Axis
from mesokit.component import component, param, tag
from mesokit.errors import CaseError
from mesokit.observe import setting
from mesokit.observe.estimate import Estimate, fit
from mesokit.observe.origins import Origins
from mesokit.observe.protocol import Observable, RunningFluid, State, pack, unpack
from mesokit.observe.result import Array, Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case


def spread_ids(wanted: int, n: int) -> NDArray[np.int64]:
    """`wanted` ids (or all) spread evenly over 0 .. n - 1.

    >>> spread_ids(3, 9)
    array([0, 3, 6])
    """
    count = min(wanted, n)
    return np.arange(count) * n // max(count, 1)


@component
class MeanSquareDisplacement(Observable):
    """Mean square displacement at lags from one sample to `max_lag`, about equally spaced in log.

    Axes along which the fluid flows or that a wall closes are left out unless given.
    """

    quantity: Literal["mean-square-displacement"] = tag("mean-square-displacement")
    particles: int = param(2000, doc="particles followed", ge=1)
    max_lag: int = param(1000, doc="longest lag", unit="steps", ge=1)
    components: tuple[Axis, ...] | None = param(
        None, doc="axes that count (all without flow and walls unless said)", min_length=1
    )

    def axes(self, case: Case) -> tuple[int, ...]:
        """The axes that count. Raises CaseError if there is none, or if images slide along one."""
        if self.components is None:
            axes = setting.quiet_axes(case)
            if not axes:
                raise CaseError("components: every axis has a flow or a wall; name those to follow")
            return axes
        axes = tuple(setting.axis_index(case, axis, "components") for axis in self.components)
        if case.box.shear_rate and 0 in axes:
            raise CaseError("components: not 'x' under box.shear_rate, whose images slide")
        return axes

    def check(self, case: Case) -> None:
        """Raise CaseError without an axis to follow."""
        self.axes(case)

    def accumulator(self, case: Case) -> MeanSquareDisplacementAccumulator:
        """An empty memory for it."""
        return MeanSquareDisplacementAccumulator(self, case)


def _square_distance(old: Array, new: Array) -> Array:
    difference = new - old
    return np.einsum("ij,ij->i", difference, difference)


class MeanSquareDisplacementAccumulator:
    """Unwrapped positions at many origins."""

    def __init__(self, observable: MeanSquareDisplacement, case: Case) -> None:
        self.observable, self.case, self.name = observable, case, observable.label
        self.axes = observable.axes(case)
        self.ids = spread_ids(observable.particles, case.particles)
        max_lag = max(1, observable.max_lag // observable.every)
        self.origins = Origins(len(self.ids), len(self.axes), max_lag)

    def observe(self, fluid: RunningFluid) -> None:
        """Take one sample."""
        position = fluid.positions(self.ids, unwrapped=True)[:, list(self.axes)]
        self.origins.add(position, _square_distance)

    def state(self) -> State:
        """All it has to remember."""
        return pack(origins=self.origins)

    def restore(self, state: Mapping[str, NDArray[Any]]) -> None:
        """Go on from `state()`."""
        self.origins.restore(unpack(state, "origins"))

    def result(self) -> Result:
        """The curve and the slope of its late part."""
        steps = self.origins.sampled() * self.observable.every
        moved = self.origins.estimate()
        dt = self.case.fluid.timestep
        coefficients = setting.transport(self.case)
        quiet = set(self.axes) <= set(setting.quiet_axes(self.case))
        expected, curve = None, None
        comparisons: list[Comparison] = []
        if coefficients is not None and quiet:
            expected = theory.msd_molecular_chaos(
                steps,
                dt,
                self.decorrelation(coefficients.diffusion),
                len(self.axes),
                self.case.fluid.kT,
                self.case.fluid.mass,
            )
        memory = self.memory_time(coefficients)
        late = steps * dt >= 5 * memory if memory else steps > 0
        if late.sum() >= 3:
            curve, comparisons = self.fit_diffusion(steps * dt, moved, late, coefficients)
        return Result(
            quantity="mean-square-displacement",
            name=self.name,
            x={"time": steps * dt},
            value=moved.value,
            error=moved.error,
            label="mean square displacement",
            units={"value": "a^2", "time": "tau"},
            expected=expected,
            fit=curve,
            theory=setting.chaos_label(self.case),
            comparisons=tuple(comparisons),
            samples=self.origins.count,
            extra={"components": "".join("xyz"[axis] for axis in self.axes)},
        )

    def decorrelation(self, diffusion: float) -> float:
        """What a collision takes of a velocity."""
        fluid = self.case.fluid
        return theory.decorrelation_from_diffusion(diffusion, fluid.timestep, fluid.kT, fluid.mass)

    def memory_time(self, coefficients: theory.Transport | None) -> float:
        """How long a particle remembers its velocity, m D/kT."""
        fluid = self.case.fluid
        return coefficients.diffusion * fluid.mass / fluid.kT if coefficients else 0.0

    def fit_diffusion(
        self,
        time: Array,
        moved: Estimate,
        late: NDArray[np.bool_],
        coefficients: theory.Transport | None,
    ) -> tuple[Array, list[Comparison]]:
        """Straight line through the late part, weighted by 1/t^2 as the errors grow like t."""
        basis = np.stack([np.ones_like(time), time], axis=1)
        weight = np.where(late, 1 / np.maximum(time, time[late][0]) ** 2, 0)
        line = fit(moved, basis, weight)
        scale = 1 / (2 * len(self.axes))
        value, error = line.scalar(line.value[1] * scale, np.array([0.0, scale]))
        expected = coefficients.diffusion if coefficients else np.nan
        return np.where(late, basis @ line.value, np.nan), [
            Comparison(
                "diffusion coefficient",
                value,
                error,
                expected,
                "a^2/tau",
                setting.chaos(self.case, "correlated collisions add 10 to 18 %"),
            )
        ]
