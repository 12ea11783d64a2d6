"""Collisions with a bath."""

import math
from typing import Literal

import numpy as np

from mesokit.case.component import component, param, tag
from mesokit.method.spheres.common.draws import normal_rows, uniform_rows
from mesokit.method.spheres.hard.heating.protocol import Heated, Heating

CHANCE, VELOCITY = 81, 82  # purposes of the random numbers, above METHOD


@component
class Andersen(Heating):
    """Now and then a sphere gets a velocity of the bath (Andersen 1980). Momentum is not kept."""

    rule: Literal["andersen"] = tag("andersen")
    rate: float = param(1.0, doc="how often for each sphere", unit="1/time", gt=0, le=1e9)
    kT: float = param(1.0, doc="thermal energy of the bath", unit="kT", gt=0, le=1e9)

    @property
    def bath_kT(self) -> float:
        return self.kT

    def act(self, heated: Heated, interval: float) -> None:
        n, d = heated.velocities.shape
        chance = uniform_rows(heated.seed, heated.turn, CHANCE, n)
        chosen = chance < -math.expm1(-self.rate * interval)
        fresh = normal_rows(heated.seed, heated.turn, VELOCITY, n, d)
        fresh *= np.sqrt(self.kT / heated.masses)[:, None]
        heated.velocities[chosen] = fresh[chosen]
