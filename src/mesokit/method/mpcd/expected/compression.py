"""How far a force that drives a fluid against solids may compress it."""

import math

from mesokit.case.case import Case
from mesokit.geometry.shape.array import Array
from mesokit.geometry.shape.plates import Plates
from mesokit.method.mpcd.expected import recognise, setting


def unit_cell(case: Case, axis: int) -> float:
    """Length after which the solids repeat along an axis: that of arrays, else the box."""
    repeats = [
        wall.repeat[axis] if isinstance(wall, Array) else 1
        for wall in case.walls
        if not isinstance(wall, Plates)
    ]
    return float(case.box.size[axis]) / max(math.gcd(*repeats), 1)


def compression(case: Case) -> tuple[int, float] | None:
    """Axis of a force that drives the fluid against solids, and acceleration length/(kT/m).

    The fluid's pressure is rho kT/m. What solids take of the force over a unit cell, at most
    rho times acceleration times length, they hand on as a difference of pressure; so the number is
    that of the density along the cell, over the density, were the fluid held altogether. None
    without a force along one axis, without solids but plates, and in a straight pipe, whose wall
    takes what the force does everywhere alike.
    """
    axis, fluid = setting.driven_axis(case), case.fluid
    if axis is None or not setting.obstructed(case) or axis in setting.closed_axes(case):
        return None
    pipe = recognise.pipe(case)
    if pipe is not None and pipe.axis == axis:
        return None
    acceleration = abs(float(setting.uniform_acceleration(case)[axis]))
    return axis, acceleration * unit_cell(case, axis) * fluid.mass / fluid.kT
