"""Vorticity across the plane of the picture: white where nothing turns, lines for either sign."""

from typing import Any

import numpy as np

from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.heat_map import heat_map
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import Scale, reach_of
from mesokit.report.flow.smooth import smoothed
from mesokit.report.style import labelled

NEEDS = "velocity"
TITLE = "vorticity"
LEVEL = 0.4  # of the largest: where the lines run
SMOOTH = 1.5  # bins
SAID = f"lines at {LEVEL:g} of the largest, dashed where it is negative"


def vorticity(flow: Flow) -> Array:
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
    slope: Array = np.gradient(values, h, axis=axis)
    return slope


def reach(flow: Flow, region: Region) -> float:
    """The largest vorticity of either sign in the region."""
    values = flow.surely(vorticity(flow))
    return reach_of(values[region.bins(flow.size, values.shape)])


def scale(flow: Flow, reach: float) -> Scale:
    """The same on either side of zero."""
    (a, b), label = flow.axes, "vorticity"
    if flow.dimension == 3:  # of three components this is one, and the sign depends on the order
        label += rf" $\partial_{a} v_{b} - \partial_{b} v_{a}$"
    return Scale(-reach, reach, "RdBu_r", labelled(label, "1/tau"))


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw it. In grey the lines tell the signs apart: dashed around negative vorticity.

    They are those of a map smoothed over some bins, which noise would tear.
    """
    values = vorticity(flow)
    heat_map(ax, flow, values, region, scale(flow, reach))
    dx, dy = spacing(flow, values)
    x, y = (np.arange(values.shape[0]) + 0.5) * dx, (np.arange(values.shape[1]) + 0.5) * dy
    level, smooth = LEVEL * reach, smoothed(values, flow.periodic, SMOOTH)
    if (abs(smooth) > level).any():
        lines = {"colors": "black", "linewidths": 0.8, "linestyles": ["--", "-"]}
        ax.contour(x, y, smooth.T, [-level, level], **lines)
