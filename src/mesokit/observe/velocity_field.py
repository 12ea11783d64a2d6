"""Map of the mean velocity over two axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from mesokit.case.box import AXES
from mesokit.case.component import component, tag
from mesokit.method.mpcd.expected import setting
from mesokit.observe.shared.estimate import Estimate, of_ratio
from mesokit.observe.shared.field import Array, Field, FieldAccumulator
from mesokit.observe.shared.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case.case import Case


FASTEST = 99.5  # percent of the bins; the few beyond are noise
ABOVE = "of the mean flow; above 0.2 the fluid is compressible"


@component
class VelocityField(Field):
    """Mean velocity on a grid over two axes: momentum over mass, every component."""

    quantity: Literal["velocity-field"] = tag("velocity-field")
    asks_transport: ClassVar[bool] = True

    def accumulator(self, case: Case) -> VelocityFieldAccumulator:
        """An empty memory for it."""
        return VelocityFieldAccumulator(self, case)


class VelocityFieldAccumulator(FieldAccumulator):
    """Mass and momentum of each bin."""

    def __init__(self, observable: VelocityField, case: Case) -> None:
        super().__init__(observable, case, width=1 + case.box.dimension)

    def sample(self, number: Array, mass: Array, momentum: Array, energy: Array) -> Array:
        """Mass, then momentum."""
        return np.concatenate([mass[None], momentum])

    def result(self) -> Result:
        """The map, and the steady flow expected."""
        sums, _ = self.blocks.sums()
        mass = np.broadcast_to(sums[:, :1], sums[:, 1:].shape)
        velocity = of_ratio(sums[:, 1:], mass)
        components = np.array(AXES[: self.case.box.dimension])
        return Result(
            quantity="velocity-field",
            drawing="map",
            name=self.name,
            x=self.coordinates | {"component": components},
            value=np.moveaxis(velocity.value, 0, -1),
            error=np.moveaxis(velocity.error, 0, -1),
            label="velocity",
            units={"value": "a/tau"} | dict.fromkeys(self.coordinates, "a"),
            expected=self.expected(),
            theory="steady flow",
            comparisons=self.comparisons(velocity),
            samples=self.blocks.count,
            extra={"bins_per_cell": self.observable.bins_per_cell},
        )

    def comparisons(self, velocity: Estimate) -> tuple[Comparison, ...]:
        """The Mach number where the flow is fastest, less what noise adds to the speed."""
        coefficients = setting.transport(self.case)
        if coefficients is None or not setting.driven(self.case) or self.case.box.sheared:
            return ()
        square = (velocity.value**2 - velocity.error**2).sum(axis=0)  # of bins
        known = np.isfinite(square)
        if not known.any():
            return ()
        place = np.nanargmin(abs(square - np.percentile(square[known], FASTEST)))
        value, error = (a.reshape(len(a), -1)[:, place] for a in (velocity.value, velocity.error))
        speed = float(np.sqrt(max(square.ravel()[place], 0.0)))
        if speed == 0:
            return ()
        spread = float(np.sqrt(((value * error) ** 2).sum()) / speed)
        sound = coefficients.sound_speed
        return (Comparison("largest Mach number", speed / sound, spread / sound, note=ABOVE),)

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
