"""Two parallel plates: a slit."""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from mesokit.box import AXES, Axis
from mesokit.component import component, param, tag
from mesokit.geometry.protocol import (
    across,
    closes,
    confine,
    exposed,
    first_hit,
    reflect,
    side,
    touches,
)
from mesokit.geometry.surface import Surface
from mesokit.scalar import added_scaled, mul_add, scalar, scaled


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
        rest = (0.0,) * len(size)
        return (SlitX, SlitY, SlitZ)[axis](
            tuple(float(length) for length in size),
            float(size[axis]),
            self.lower.velocity or rest,
            self.upper.velocity or rest,
            1.0 if self.lower.rule == "slip" else 0.0,
            1.0 if self.upper.rule == "slip" else 0.0,
        )


class Slit(NamedTuple):
    """Fluid in 0 <= height <= width; surface 0 is the lower plate, 1 the upper."""

    size: tuple[float, ...]
    width: float
    lower_velocity: tuple[float, ...]
    upper_velocity: tuple[float, ...]
    lower_slips: float
    upper_slips: float


# A class for each axis, so that picking the height out of a position costs nothing.


class SlitX(Slit):
    """Plates across x."""

    __slots__ = ()


class SlitY(Slit):
    """Plates across y."""

    __slots__ = ()


class SlitZ(Slit):
    """Plates across z."""

    __slots__ = ()


@across.register(SlitX)
def _(solid):
    return 0


@across.register(SlitY)
def _(solid):
    return 1


@across.register(SlitZ)
def _(solid):
    return 2


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


@touches.register(SlitX, SlitY, SlitZ)
def _(solid, r, v, a, time):
    k = across(solid)
    h, end = r[k], mul_add(v[k], time, r[k])
    bend = 0.5 * time * time * abs(a[k])  # no parabola is further from its straight line
    return (min(h, end) - bend <= 0.0) | (max(h, end) + bend >= solid.width)


@first_hit.register(SlitX, SlitY, SlitZ)
def _(solid, r, v, a, time):
    k = across(solid)
    below = time_to_fall(r[k], v[k], a[k], time)
    above = time_to_fall(solid.width - r[k], -v[k], -a[k], time)
    return (below, 0) if below < above else (above, 1)


@reflect.register(SlitX, SlitY, SlitZ)
def _(solid, surface, v):
    k = across(solid)
    u = solid.lower_velocity if surface == 0 else solid.upper_velocity
    slips = solid.lower_slips if surface == 0 else solid.upper_slips
    back = added_scaled(scaled(2.0, u), -1.0, v)
    mirrored = tuple_setitem(v, k, -v[k])
    return mirrored if slips > 0.5 else back


@confine.register(SlitX, SlitY, SlitZ)
def _(solid, r):
    k = across(solid)
    return tuple_setitem(r, k, min(max(r[k], 0.0), solid.width))


@exposed.register(SlitX, SlitY, SlitZ)
def _(solid):
    return True


@closes.register(SlitX, SlitY, SlitZ)
def _(solid, place, shift, lower_rate, upper_rate):
    # Cells end at heights k - shift: the part of shift after the point is the depth of the lower
    # layer of cut cells in its plate, and the rest of one cell that of the upper.
    axis = across(solid)
    below = shift[axis] - np.floor(shift[axis])
    depth = place[axis]
    low = depth < below
    behind = depth if low else depth - below
    for k in range(len(place)):
        u = solid.lower_velocity[k] if low else solid.upper_velocity[k]
        rate = lower_rate[k] if low else upper_rate[k]
        shift = tuple_setitem(shift, k, u - behind * rate)
        place = tuple_setitem(place, k, place[k] * solid.size[k])
    return tuple_setitem(place, axis, -behind if low else solid.width + behind), shift


@side.register(SlitX, SlitY, SlitZ)
def _(solid, r):
    low = r[across(solid)] < 0.5 * solid.width
    slips = solid.lower_slips if low else solid.upper_slips
    surface = 0 if low else 1
    return 2 if slips > 0.5 else surface
