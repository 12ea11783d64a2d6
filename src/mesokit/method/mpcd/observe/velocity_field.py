"""Map of the mean velocity over two axes."""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.case.component import component, tag
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.field import Array, Field, FieldAccumulator
from mesokit.seam.estimate import Estimate, of_ratio, per_block
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Comparison, Result

FASTEST = 99.5  # percent of the bins are slower than those of the Mach number
ABOVE = (
    "of the fastest 0.5 % of the mean flow, low where noise hides them; above 0.2 the fluid is "
    "compressible"
)


@component
class VelocityField(Field):
    """Mean velocity on a grid over two axes: momentum over mass, every component."""

    quantity: Literal["velocity-field"] = tag("velocity-field")
    asks_transport: ClassVar[bool] = True
    of_built_up_flow: ClassVar[bool] = True
    drawing = "map"
    value_label = "velocity"


@accumulator_of(VelocityField)
class VelocityFieldAccumulator(FieldAccumulator):
    """Mass and momentum of each bin."""

    def __init__(self, observable: VelocityField, case: Case) -> None:
        super().__init__(observable, case, width=1 + case.box.dimension)

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        return np.concatenate([mass[None], momentum])

    def result(self) -> Result:
        sums, _ = self.blocks.sums()
        mass = np.broadcast_to(sums[:, :1], sums[:, 1:].shape)
        velocity = of_ratio(sums[:, 1:], mass)
        components = np.array(AXES[: self.case.box.dimension])
        return self.report(
            self.coordinates | {"component": components},
            (np.moveaxis(velocity.value, 0, -1), np.moveaxis(velocity.error, 0, -1)),
            self.comparisons(sums, velocity),
            units={"value": "a/tau"} | dict.fromkeys(self.coordinates, "a"),
            expected=self.expected(),
            theory="steady flow",
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    def comparisons(self, sums: Array, velocity: Estimate) -> Iterator[Comparison]:
        coefficients = setting.transport(self.case)
        if coefficients is None or not setting.driven(self.case) or self.case.box.sheared:
            return
        speed, error = fastest(sums, velocity)
        if not speed > 0:
            return
        sound = coefficients.sound_speed
        yield Comparison("largest Mach number", speed / sound, error / sound, note=ABOVE)

    def expected(self) -> Array | None:
        """The flow where it varies along an axis of the map, else nan."""
        expected = np.full((*self.bins, self.case.box.dimension), np.nan)
        for direction in range(self.case.box.dimension):
            flow = setting.flow(self.case, direction)
            if flow.across in self.axes:
                place = self.axes.index(flow.across)
                profile = flow.bins(flow.across, self.edges[place])
                if profile is not None:
                    expected[..., direction] = profile[:, None] if place == 0 else profile
        return None if np.isnan(expected).all() else expected


def fastest(sums: Array, velocity: Estimate) -> tuple[float, float]:
    """Mean speed of the fastest bins, and its error; nan where the run is too short for it.

    The largest of many noisy speeds is too large. Bins and directions are therefore chosen in one
    half of the run, and the velocities along them are measured in the other half.

    Parameters
    ----------
    sums: (blocks, 1 + d, *bins) of mass and momentum.
    velocity: (d, *bins), drawn from the same blocks.
    """
    early = np.arange(len(sums)) < len(sums) // 2
    speeds, residuals = [], np.zeros(len(sums))
    for half in (early, ~early):
        with np.errstate(invalid="ignore", divide="ignore"):
            chosen_in, measured_in = (
                s[1:] / s[0] for s in (sums[~half].sum(axis=0), sums[half].sum(axis=0))
            )
        speed = np.sqrt((chosen_in**2).sum(axis=0))
        known = np.isfinite(speed) & np.isfinite(measured_in).all(axis=0) & (speed > 0)
        if not half.any() or not known.any():
            return float("nan"), float("nan")
        chosen = known & (speed >= np.percentile(speed[known], FASTEST))
        along = chosen_in[:, chosen] / speed[chosen] / chosen.sum()
        speeds.append(float((measured_in[:, chosen] * along).sum()))
        of_blocks = (velocity.residuals[half][:, :, chosen] * along).sum(axis=(1, 2))
        residuals[half] = of_blocks - of_blocks.mean()  # which is what the choice has shifted
    error = Estimate(velocity.value, residuals, per_block(velocity.weights)).error
    return float(np.mean(speeds)), float(error)
