"""An acceleration that varies as a sine across the flow: Kolmogorov flow."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import ClassVar, Literal, NamedTuple

import numpy as np

from mesokit import theory
from mesokit.case.box import AXES, Axis
from mesokit.case.component import component, param, show, tag
from mesokit.method.mpcd.field.protocol import Driven, Force, acceleration
from mesokit.scalar.elementary import sincos_turn
from mesokit.scalar.intrinsics import floor
from mesokit.scalar.vector import dot, scaled


@component
class Sinusoidal(Force):
    """Acceleration along `flow` of amplitude * sin(2 pi waves r/L), r and L along `gradient`."""

    rule: Literal["sinusoidal"] = tag("sinusoidal")
    amplitude: float = param(doc="largest acceleration", unit="a/time^2")
    flow: Axis = param("x", doc="axis of the acceleration")
    gradient: Axis = param("y", doc="axis along which it varies")
    waves: int = param(1, doc="number of waves in the box", ge=1)

    gathers: ClassVar[bool] = False  # it is the same all along itself

    @property
    def largest(self) -> float:
        return abs(self.amplitude)

    def waves_across(self) -> int:
        return self.waves

    def axes(self) -> dict[str, str]:
        return {"flow": self.flow, "gradient": self.gradient}

    def problems(self, closed: Collection[str]) -> Iterator[str]:
        """A sine across its own direction, and along the plates."""
        if self.flow == self.gradient:
            yield f"gradient = {show(self.gradient)}: expected another axis than flow"
        if self.flow in closed:
            yield f"flow = {show(self.flow)}: expected an axis that no wall closes"

    def steady_flow(self, component: int, size: tuple[int, ...], viscosity: float | None) -> Driven:
        across = AXES.index(self.gradient)
        if AXES.index(self.flow) != component:
            return Driven("rest", across, np.zeros_like)
        if viscosity is None or across == component:
            return Driven("kolmogorov", across, None)
        length, nu = size[across], viscosity
        return Driven(
            "kolmogorov",
            across,
            lambda y: theory.kolmogorov_velocity(y, length, self.amplitude, nu, waves=self.waves),
        )

    def drives(self, component: int) -> bool:
        return AXES.index(self.flow) == component

    def instability(self, reynolds: float, size: tuple[int, ...], across: int) -> str:
        if reynolds <= 1.4 or size[AXES.index(self.flow)] <= size[across] / self.waves:
            return ""
        return (
            f"Kolmogorov flow at Reynolds number {reynolds:.2g} (above 1.4) breaks up in a box "
            "that is longer along the flow than one wave; make it square"
        )

    def kernel(self, size: tuple[int, ...]) -> Wave:
        flow, gradient = AXES.index(self.flow), AXES.index(self.gradient)
        along = tuple(self.amplitude * (k == flow) for k in range(len(size)))
        turns = tuple((self.waves / size[k]) * (k == gradient) for k in range(len(size)))
        return Wave(along, turns)


class Wave(NamedTuple):
    """Amplitude of the acceleration, and the wave vector in turns per cell."""

    vector: tuple[float, ...]
    turns: tuple[float, ...]


@acceleration.register(Wave)
def _(field, r):
    phase = dot(field.turns, r)
    sin, _ = sincos_turn(phase - floor(phase))
    return scaled(sin, field.vector)
