"""Two parallel plates: a slit."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.box import AXES, Axis
from mesokit.component import component, param, tag
from mesokit.geometry.protocol import (
    closes,
    confine,
    exposed,
    first_hit,
    reflect,
    side,
    touches,
)
from mesokit.geometry.surface import Surface
from mesokit.scalar import added, dot, scalar, scaled


@component
class Plates:
    """Two plates at the ends of one axis of the box; the other axes stay periodic."""

    shape: Literal["plates"] = tag("plates")
    axis: Axis = param(doc="axis that the plates close")
    lower: Surface = param(Surface(), doc="the plate at 0")
    upper: Surface = param(Surface(), doc="the plate at the far end")
    virtual: Literal["extrapolate", "fill", "top-up", "none"] = param(
        "extrapolate",
        doc="virtual particles in the cells that a no-slip plate cuts: 'fill' the solid part with "
        "a gas at the plate's velocity, 'extrapolate' the fluid's velocity into that gas, 'top-up' "
        "each cell to the mean density, or 'none'",
    )

    def kernel(self, size: tuple[int, ...]) -> Slit:
        """Parameters for the scalar functions below."""
        axis = AXES.index(self.axis)
        normal = tuple(float(k == axis) for k in range(len(size)))
        rest = (0.0,) * len(size)
        return Slit(
            normal,
            tuple(float(length) for length in size),
            float(size[axis]),
            self.lower.velocity or rest,
            self.upper.velocity or rest,
            1.0 if self.lower.rule == "slip" else 0.0,
            1.0 if self.upper.rule == "slip" else 0.0,
        )


class Slit(NamedTuple):
    """Fluid in 0 <= r . normal <= width; surface 0 is the lower plate, 1 the upper."""

    normal: tuple[float, ...]
    size: tuple[float, ...]
    width: float
    lower_velocity: tuple[float, ...]
    upper_velocity: tuple[float, ...]
    lower_slips: float
    upper_slips: float


@scalar
def time_to_fall(height, v, a, time):
    """When a particle at a height >= 0 above a plate reaches it; more than `time` if it does not.

    Of the two roots of height + v t + a t^2 / 2 = 0 it is the one with a downward velocity, in the
    form without cancellation.
    """
    square = v * v - 2.0 * a * height
    down = math.sqrt(max(square, 0.0))
    late = 2.0 * time + 1.0
    if square < 0.0 or down == 0.0:
        return late
    if v < 0.0:
        return 2.0 * height / (down - v)
    return -(v + down) / a if a < 0.0 else late


@touches.register(Slit)
def _(solid, r, v, a, time):
    h, w, g = dot(solid.normal, r), dot(solid.normal, v), dot(solid.normal, a)
    end = h + w * time + 0.5 * g * time * time
    final = w + g * time
    # A flight whose normal velocity changes sign may touch a plate and come back.
    turns = w * final < 0.0
    bulge = (abs(w) + abs(final)) * time if turns else 0.0
    low, high = min(h, end) - bulge, max(h, end) + bulge
    return (low <= 0.0) | (high >= solid.width)


@first_hit.register(Slit)
def _(solid, r, v, a, time):
    h, w, g = dot(solid.normal, r), dot(solid.normal, v), dot(solid.normal, a)
    below = time_to_fall(h, w, g, time)
    above = time_to_fall(solid.width - h, -w, -g, time)
    return (below, 0) if below < above else (above, 1)


@reflect.register(Slit)
def _(solid, surface, v):
    u = solid.lower_velocity if surface == 0 else solid.upper_velocity
    slips = solid.lower_slips if surface == 0 else solid.upper_slips
    back = added(scaled(2.0, u), scaled(-1.0, v))
    mirrored = added(v, scaled(-2.0 * dot(solid.normal, v), solid.normal))
    return mirrored if slips > 0.5 else back


@confine.register(Slit)
def _(solid, r):
    h = dot(solid.normal, r)
    inside = min(max(h, 0.0), solid.width)
    return added(r, scaled(inside - h, solid.normal))


@exposed.register(Slit)
def _(solid):
    return True


@closes.register(Slit)
def _(solid, place, shift, lower_rate, upper_rate):
    # Cells end at heights k - shift: the part of shift after the point is the depth of the lower
    # layer of cut cells in its plate, and the rest of one cell that of the upper.
    s = dot(solid.normal, shift)
    below = s - np.floor(s)
    depth = dot(solid.normal, place)
    low = depth < below
    height = -depth if low else solid.width + (depth - below)
    for k in range(len(place)):
        along = place[k] * solid.size[k]
        place = tuple_setitem(place, k, height if solid.normal[k] > 0.5 else along)
    behind = depth if low else depth - below
    for k in range(len(place)):
        u = solid.lower_velocity[k] if low else solid.upper_velocity[k]
        rate = lower_rate[k] if low else upper_rate[k]
        shift = tuple_setitem(shift, k, u - behind * rate)
    return place, shift


@side.register(Slit)
def _(solid, r):
    low = dot(solid.normal, r) < 0.5 * solid.width
    slips = solid.lower_slips if low else solid.upper_slips
    surface = 0 if low else 1
    return 2 if slips > 0.5 else surface
