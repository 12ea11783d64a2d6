"""Velocity as arrows, with one of a known length above the picture."""

import math
from typing import Any

import numpy as np

from mesokit.report.caption import symbols
from mesokit.report.flow.data import Array, Flow, spacing
from mesokit.report.flow.layout import KEY_BESIDE
from mesokit.report.flow.region import Region
from mesokit.report.flow.scale import inches_of, reach_of

NEEDS = "velocity"
TITLE = "velocity"
ARROWS, FEWEST = 32, 8  # at most along the longer side, and about at least along the shorter
FILLED = 0.8  # of the bins of an arrow that are fluid: one in or at a solid would lie half under it
THICK, THICKEST = 0.07, 0.013  # of the distance between arrows; inches


def arrows(flow: Flow, region: Region) -> tuple[Array, Array, Array]:
    """Places x (nx,) and y (ny,) of the arrows and velocities (nx, ny, 2).

    Each arrow is the mean over some bins, as many as leave at most ARROWS along the longer side.
    """
    assert flow.velocity is not None
    velocity = flow.surely(flow.velocity)
    (first, side, nx), (below, height, ny) = (
        _blocks(bins, ARROWS * length / max(region.extent))
        for bins, length in zip(region.bins(flow.size, velocity.shape), region.extent, strict=True)
    )
    used = velocity[first : first + side * nx, below : below + height * ny]
    used = used.reshape(nx, side, ny, height, 2)
    filled = np.isfinite(used)
    with np.errstate(invalid="ignore"):
        mean = np.where(filled, used, 0.0).sum(axis=(1, 3)) / filled.sum(axis=(1, 3))
    mean[filled.mean(axis=(1, 3)) < FILLED] = np.nan
    dx, dy = spacing(flow, velocity)
    x = (first + side * (np.arange(nx) + 0.5)) * dx
    y = (below + height * (np.arange(ny) + 0.5)) * dy
    return x, y, mean


def _blocks(bins: slice, wanted: float) -> tuple[int, int, int]:
    """First bin, bins of each arrow, and arrows; what is left over goes to both ends."""
    number = bins.stop - bins.start
    side = min(math.ceil(number / max(wanted, FEWEST)), number)
    count = number // side
    return bins.start + (number - count * side) // 2, side, count


def reach(flow: Flow, region: Region) -> float:
    """The length of the longest arrow."""
    mean = arrows(flow, region)[2]
    return reach_of(np.hypot(mean[..., 0], mean[..., 1]))


def scale(flow: Flow, reach: float) -> None:
    """No colours."""


def draw(ax: Any, flow: Flow, region: Region, reach: float) -> None:
    """Draw it: the longest arrow ends where the next one starts."""
    x, y, velocity = arrows(flow, region)
    number, (width, height) = max(len(x), len(y)), inches_of(ax)
    thick = min(THICKEST, THICK * max(width, height) / number)
    units = {"angles": "xy", "scale_units": "xy", "scale": reach * number / max(region.extent)}
    heads = {"headwidth": 4.5, "headlength": 5, "headaxislength": 4.5, "minlength": 0.5}
    look = {"pivot": "mid", "color": "black", "units": "inches", "width": thick}
    drawn = ax.quiver(x, y, *velocity.T, **units, **look, **heads)
    known = _round(reach)
    place = 0.97, 1 + (0.14 if width > KEY_BESIDE else 0.36) / height
    text: Any = {"labelpos": "W", "labelsep": 0.08, "fontproperties": {"size": 9}}
    ax.quiverkey(drawn, *place, known, f"{known:g} {symbols('a/tau')}", coordinates="axes", **text)


def _round(value: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not above the value.

    >>> _round(0.37), _round(0.06)
    (0.2, 0.05)
    """
    power = 10.0 ** math.floor(math.log10(value))
    return float(f"{next(f for f in (5, 2, 1) if f * power <= value * (1 + 1e-9)) * power:.0e}")
