"""Temperature of a fluid without a thermostat under friction."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.box import AXES
from mesokit.case.case import Case
from mesokit.geometry.solids.solids import slit_of
from mesokit.method.mpcd.expected import recognise, setting

Array = NDArray[np.floating[Any]]
POINTS = 401  # across the flow
FILLED = ("extrapolate", "fill")  # virtual particles as dense as the fluid
CONVERGED, ROUNDS = 1e-4, 60
NODES = 9  # temperatures between which coefficients are linear
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
    fluid, known = case.fluid, setting.transport(case) or setting.solvent(case)
    if known is None and fluid.molecule is not None and fluid.collision.acts and not fluid.mixed:
        known = setting.of_gas(case)  # bonds add to the friction
    if setting.isothermal(case) or known is None:
        return None
    pipe, length, nu = recognise.pipe(case), float(case.box.size[across]), known.viscosity
    if pipe is not None:  # heat per volume and time: power of the force on the mean flow
        acceleration = abs(float(setting.uniform_acceleration(case)[pipe.axis]))
        rate = theory.hagen_poiseuille_flow_rate(pipe.radius, acceleration, nu)
        heat = setting.mass_density(case) * acceleration * rate / (math.pi * pipe.radius**2)
    else:
        y = np.linspace(0, length, POINTS)
        flows = [setting.flow(case, i) for i in range(case.box.dimension)]
        rates = [np.gradient(flow.profile(y), y) for flow in flows if flow.profile is not None]
        squares = np.sum([rate**2 for rate in rates], axis=0) + np.zeros_like(y)
        heat = float(np.mean(fluid.density * fluid.mass * nu * squares))
    changing, history = 0.0, case.box.history  # mean square of the shear rate without a theory
    if history is not None and not case.walls and setting.flow(case, 0).profile is None:
        time = (case.run.warmup + case.run.steps) * float(fluid.timestep)
        time = min(time, history.repeats_after or time)
        shears = [history.rate_at((i + 0.5) * time / POINTS) for i in range(POINTS)]
        changing = float(np.mean(np.square(shears)))
    heat += setting.mass_density(case) * nu * changing
    moved = nu * (setting.surface_speed(case) / length) ** 2
    mean = max(heat / fluid.density, fluid.mass * moved)
    rise = temperature_rise(case)
    steady = None if rise is None else float(np.mean(rise)) / fluid.kT
    return Heating(2 / case.box.dimension * mean / fluid.kT, steady)


def temperature_rise(case: Case) -> Array | None:
    """Steady rise of kT at evenly spaced heights from plate to plate; None without a theory.

    Density, viscosity and conductivity are those of the temperature at each height, at the same
    pressure everywhere.
    """
    plates = slit_of(case)
    if plates is None or setting.isothermal(case) or setting.caveat(case):
        return None
    if case.box.sheared or plates.virtual not in FILLED:
        return None
    taking = [surface.rule == "no-slip" for surface in (plates.lower, plates.upper)]
    across = AXES.index(plates.axis)
    flows = [setting.flow(case, i) for i in range(case.box.dimension)]
    unknown = any(flow.profile is None for flow in flows)
    if not any(taking) or setting.uniform_acceleration(case)[across] or unknown:
        return None
    rise = np.zeros(POINTS)
    for _ in range(ROUNDS):
        here = _local(case, case.fluid.kT + rise)
        if here is None:
            return None
        found = theory.slit_temperature_rise(
            _work(case, across, taking, here),
            float(case.box.size[across]),
            here.conductivity,
            *(jump if takes else None for jump, takes in zip(here.jumps, taking, strict=True)),
        )
        if np.abs(found - rise).max() <= CONVERGED * case.fluid.kT:
            return found
        rise = (rise + found) / 2
    return None


def settled(case: Case, across: int) -> bool:
    """Whether the warm-up is long enough for the temperature to become steady."""
    found = heating(case, across)
    warmup = case.run.warmup * case.fluid.timestep
    return found is not None and found.time is not None and warmup >= SETTLED * found.time


class _Local(NamedTuple):
    """Properties (POINTS,) of the fluid at evenly spaced heights, and the jumps at both plates."""

    density: Array
    viscosity: Array  # dynamic
    conductivity: Array
    jumps: tuple[float, float]


def _local(case: Case, kT: Array) -> _Local | None:
    """Of an ideal gas of these temperatures, as dense in the mean as the case has it; None
    without a theory."""
    fluid, rule = case.fluid, case.fluid.collision
    density = 1 / kT
    density *= fluid.density / (np.trapezoid(density) / (len(kT) - 1))
    nodes = np.linspace(kT.min(), kT.max() * (1 + 1e-9), NODES)
    known = []
    for node in nodes:
        at = setting.gas(case)._replace(kT=node, density=density[0] * kT[0] / node)
        walls, coefficients = rule.heat_at_walls(at), rule.transport(at)
        if walls is None or coefficients is None:
            return None
        known.append((coefficients.dynamic_viscosity, walls.conductivity, walls.jump))
    viscosity, conductivity, jump = (np.interp(kT, nodes, values) for values in np.transpose(known))
    return _Local(density, viscosity, conductivity, (float(jump[0]), float(jump[-1])))


def _work(case: Case, across: int, sticky: list[bool], here: _Local) -> Array:
    """Heat of friction per volume and time: stress squared over viscosity.

    The stress falls from plate to plate by the force on the fluid between; a slip plate takes
    none, and of two that hold the fluid the velocities give how much each takes.
    """
    plates = slit_of(case)
    assert plates is not None
    step, heat = float(case.box.size[across]) / (POINTS - 1), np.zeros(POINTS)
    for i, acceleration in enumerate(setting.uniform_acceleration(case)):
        if i == across:
            continue
        weight = _running(case.fluid.mass * here.density * acceleration, step)
        at_lower = weight[-1] if sticky[0] else 0.0
        if all(sticky):
            lower, upper = (setting.surface_velocity(s, i) for s in (plates.lower, plates.upper))
            fluidity = _running(1 / here.viscosity, step)[-1]
            at_lower = (upper - lower + _running(weight / here.viscosity, step)[-1]) / fluidity
        heat += (at_lower - weight) ** 2 / here.viscosity
    return heat


def _running(values: Array, step: float) -> Array:
    """Integral from the lower plate to each height, by the trapezoidal rule."""
    return np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) * step / 2)])
