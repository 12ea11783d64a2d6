"""Maps of a number in each bin: density, speed, and vorticity across the plane of the picture."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, heat_map, reach_of
from mesokit.report.flow.smooth import smoothed
from mesokit.report.style import labelled

LEVEL = 0.4  # of the largest vorticity: where lines run
SMOOTH = 1.5  # bins over which the vorticity of the lines is smoothed
LINES = f"lines at {LEVEL:g} of the largest, dashed where it is negative"


@dataclass(eq=False)
class Map:
    """A panel that shows values (nx, ny) as colours."""

    NEEDS: str
    TITLE: str
    values: Callable[[Flow], Any]
    scale: Callable[[Flow, float], Scale]

    def reach(self, flow: Flow, region: Region) -> float:
        """The largest size of a value in the region."""
        values = flow.surely(self.values(flow))
        return reach_of(values[region.bins(flow.size, values.shape)])

    def draw(self, ax: Any, flow: Flow, region: Region, reach: float) -> None:
        """Draw the bins of the region."""
        heat_map(ax, flow, self.values(flow), region, self.scale(flow, reach))


class SignedMap(Map):
    """A map with lines around its extremes, by which the signs differ in grey."""

    def draw(self, ax: Any, flow: Flow, region: Region, reach: float) -> None:
        """The lines are those of values smoothed over some bins: noise would break them."""
        super().draw(ax, flow, region, reach)
        values = self.values(flow)
        sides = zip(values.shape, spacing(flow, values), strict=True)
        x, y = ((np.arange(n) + 0.5) * side for n, side in sides)
        level, smooth = LEVEL * reach, smoothed(values, flow.periodic, SMOOTH)
        if (abs(smooth) > level).any():
            lines = {"colors": "black", "linewidths": 0.8, "linestyles": ["--", "-"]}
            ax.contour(x, y, smooth.T, [-level, level], **lines)


def speed_label(flow: Flow) -> str:
    """The name of the speed in a picture."""
    return labelled("speed" if flow.dimension == 2 else "speed in the plane", "a/tau")


def vorticity_of(flow: Flow) -> Array:
    """Change of the second component along the first axis less that of the first along the second.

    Central differences, one-sided ones at a wall; nan in and next to bins without fluid. A rigid
    rotation has twice its angular velocity, positive from the first axis to the second.
    """
    velocity = flow.velocity
    assert velocity is not None
    h = spacing(flow, velocity)
    turning = _slope(velocity[..., 1], 0, h[0], flow.periodic[0])
    turning -= _slope(velocity[..., 0], 1, h[1], flow.periodic[1])
    turning[np.isnan(velocity).any(axis=-1)] = np.nan
    return turning


def _slope(values: Array, axis: int, h: float, periodic: bool) -> Array:
    if periodic:
        return (np.roll(values, -1, axis) - np.roll(values, 1, axis)) / (2 * h)
    return np.asarray(np.gradient(values, h, axis=axis))


def _vorticity_scale(flow: Flow, reach: float) -> Scale:
    (a, b), label = flow.axes, "vorticity"
    if flow.dimension == 3:  # of three components this is one, and the sign depends on the order
        label += rf" $\partial_{a} v_{b} - \partial_{b} v_{a}$"
    return Scale(-reach, reach, "RdBu_r", labelled(label, "1/tau"))


density = Map(
    "density",
    "occupancy",
    lambda flow: flow.density,
    lambda flow, reach: Scale(
        flow.lowest, reach, "cividis", labelled("density", f"1/a^{flow.dimension}")
    ),
)
speed = Map(
    "velocity",
    "speed",
    lambda flow: flow.speed,
    lambda flow, reach: Scale(0.0, reach, "viridis", speed_label(flow)),
)
vorticity = SignedMap("velocity", "vorticity", vorticity_of, _vorticity_scale)
