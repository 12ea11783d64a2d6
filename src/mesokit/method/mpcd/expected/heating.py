"""What friction makes of the temperature of a fluid that no thermostat holds."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import setting

if TYPE_CHECKING:
    from mesokit.case.case import Case

Array = NDArray[np.floating[Any]]
POINTS = 401  # across the flow
FILLED = ("extrapolate", "fill")  # virtual particles as dense as the fluid
CONVERGED, ROUNDS = 1e-4, 60
SETTLED = 5.0  # times in which the temperature comes within 1/e, until it is steady


class Heating(NamedTuple):
    """Relative rise of the mean temperature: its rate at first, and at last, None if not known."""

    rate: float
    steady: float | None

    @property
    def time(self) -> float | None:
        """In which it comes within 1/e of the steady state, None without one."""
        return self.steady / self.rate if self.steady is not None and self.rate else None

    def after(self, time: float) -> float:
        """At that time: right at first and at last, an exponential approach between.

        >>> Heating(0.01, 0.5).after(1e9), round(Heating(0.01, 0.5).after(1), 4)
        (0.5, 0.0099)
        >>> Heating(0.01, None).after(100)
        1.0
        """
        if self.steady is None or not self.steady:
            return self.rate * time
        return -self.steady * math.expm1(-self.rate * time / self.steady)


def heating(case: Case, across: int) -> Heating | None:
    """Of the steady flow that varies along axis number `across`; None if the fluid is held.

    About solids that move, of a flow that falls to zero over the whole box: they heat it no less.
    """
    known = setting.transport(case)
    if setting.isothermal(case) or known is None:
        return None
    heat, length = _friction(case, across, known.viscosity), float(case.box.size[across])
    moved = known.viscosity * (setting.surface_speed(case) / length) ** 2
    fluid = case.fluid
    mean = max(float(np.mean(heat)) / fluid.density, fluid.mass * moved)
    rise = temperature_rise(case)
    steady = None if rise is None else float(np.mean(rise)) / fluid.kT
    return Heating(2 / case.box.dimension * mean / fluid.kT, steady)


def temperature_rise(case: Case) -> Array | None:
    """Steady rise of kT at evenly spaced heights from plate to plate; None without a theory.

    Viscosity, conductivity and flow are those of the mean temperature.
    """
    plates = slit_of(case)
    if plates is None or setting.isothermal(case) or setting.caveat(case):
        return None
    if case.box.sheared or plates.virtual not in FILLED:
        return None
    taking = [surface.rule == "no-slip" for surface in (plates.lower, plates.upper)]
    across = AXES.index(plates.axis)
    if not any(taking) or setting.acceleration(case)[across]:
        return None
    fluid, mean = case.fluid, 0.0
    rise: Array | None = None
    for _ in range(ROUNDS):
        warmer = dataclasses.replace(fluid, kT=fluid.kT + mean)
        bare = {"observe": (), "trajectory": None, "log": None}
        rise = _rise(dataclasses.replace(case, fluid=warmer, **bare), across, taking)
        if rise is None:
            return None
        found = float(np.mean(rise))
        if abs(found - mean) <= CONVERGED * fluid.kT:
            return rise
        mean = (mean + found) / 2
    return None


def settled(case: Case, across: int) -> bool:
    """Whether the warm-up is long enough for the temperature to become steady."""
    found = heating(case, across)
    warmup = case.run.warmup * case.fluid.timestep
    return found is not None and found.time is not None and warmup >= SETTLED * found.time


def _rise(case: Case, across: int, taking: list[bool]) -> Array | None:
    """Of a fluid with the properties that it has at kT."""
    known, walls = setting.transport(case), case.fluid.collision.heat_at_walls(setting.gas(case))
    if known is None or walls is None:
        return None
    height = float(case.box.size[across])
    lower, upper = (walls.jump if takes else None for takes in taking)
    heat = _friction(case, across, known.viscosity)
    return theory.slit_temperature_rise(heat, height, walls.conductivity, lower, upper)


def _friction(case: Case, across: int, viscosity: float) -> Array:
    """What friction heats, per volume and time, at evenly spaced heights."""
    y = np.linspace(0, float(case.box.size[across]), POINTS)
    flows = [setting.flow(case, i) for i in range(case.box.dimension)]
    rates = [np.gradient(flow.profile(y), y) for flow in flows if flow.profile is not None]
    dynamic = case.fluid.density * case.fluid.mass * viscosity
    return dynamic * np.sum([rate**2 for rate in rates], axis=0) + np.zeros_like(y)
