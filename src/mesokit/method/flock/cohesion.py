"""Repulsion and cohesion: what birds add to the mean heading (Gregoire, Chate and Tu 2003)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from pydantic import model_validator

from mesokit.case.component import component, param, show
from mesokit.scalar.jit import scalar


@component
class Cohesion:
    """A bird also turns away from birds that are too near and towards those that are far.

    To the sum of the headings each bird in reach adds strength * f(r) along the way to it, with
    f = (r - equilibrium) / (4 (attraction - equilibrium)) up to `attraction` and 1 beyond; where
    there are birds nearer than `core`, they alone count, and the bird flies away from them. Source:
    Gregoire, Chate and Tu, Physica D 181, 157 (2003), there among Voronoi neighbours.
    """

    strength: float = param(1.0, doc="weight relative to the headings", gt=0, le=1e3)
    core: float = param(0.2, doc="birds nearer than this are fled from", unit="length", ge=0)
    equilibrium: float = param(0.5, doc="distance that is sought", unit="length", gt=0)
    attraction: float = param(0.8, doc="from here on attraction is full", unit="length", gt=0)

    @model_validator(mode="after")
    def _in_order(self) -> Cohesion:
        if not self.core < self.equilibrium < self.attraction:
            raise ValueError(
                f"attraction = {show(self.attraction)}: expected core < equilibrium < attraction, "
                f"not {show(self.core)}, {show(self.equilibrium)}, {show(self.attraction)}"
            )
        return self

    def kernel(self) -> Pull:
        """Parameters for the scalar functions below."""
        slope = 0.25 / (self.attraction - self.equilibrium)
        lengths = self.core, self.equilibrium, self.attraction
        return Pull(self.strength, *(np.float32(x) for x in (*lengths, slope)))


class Pull(NamedTuple):
    """Weight; lengths, and the slope of f between the first and the last, as float32."""

    strength: float
    core: np.float32
    equilibrium: np.float32
    attraction: np.float32
    slope: np.float32


@scalar
def pull(cohesion, square):
    """f(r) over r, for the square of the distance r of a bird beyond the core, as float32."""
    r = np.float32(math.sqrt(square))
    f = np.float32((r - cohesion.equilibrium) * cohesion.slope)
    return np.float32((f if r < cohesion.attraction else np.float32(1.0)) / r)
