"""An acceleration that varies as a sine across the flow: Kolmogorov flow."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from mesokit.box import AXES, Axis
from mesokit.component import component, param, tag
from mesokit.elementary import sincos_turn
from mesokit.mpcd.field.protocol import acceleration
from mesokit.scalar import dot, scaled


@component
class Sinusoidal:
    """Acceleration along `flow` of amplitude * sin(2 pi waves r/L), r and L along `gradient`."""

    rule: Literal["sinusoidal"] = tag("sinusoidal")
    amplitude: float = param(doc="largest acceleration", unit="a/time^2")
    flow: Axis = param("x", doc="axis of the acceleration")
    gradient: Axis = param("y", doc="axis along which it varies")
    waves: int = param(1, doc="number of waves in the box", ge=1)

    @property
    def largest(self) -> float:
        """Largest size of the acceleration."""
        return abs(self.amplitude)

    def kernel(self, size: tuple[int, ...]) -> Wave:
        """Parameters for the scalar function below."""
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
    sin, _ = sincos_turn(phase - np.floor(phase))
    return scaled(sin, field.vector)
