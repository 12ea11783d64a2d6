"""Heat that a fluid without a thermostat conducts, and hands to walls of virtual particles."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import one_of, positive
from mesokit.theory.transport import Angle, Rule, cell_memory, transport

Array = NDArray[np.float64]
MILNE = (1 / 7, 0.0845, 1.355)  # limit of long flights, what short ones add, and how that fades


class HeatAtWalls(NamedTuple):
    """Conductivity (heat flux over gradient of kT), and length of the jump at walls, in cells."""

    conductivity: float
    jump: float


def heat_at_walls(
    rule: Rule,
    dimension: int,
    density: float,
    timestep: float,
    angle: Angle = None,
    kT: float = 1.0,
    mass: float = 1.0,
) -> HeatAtWalls:
    """Conductivity of heat, and the jump of the temperature at walls of virtual particles.

    Parameters as in `transport`. Particles bounce back from a wall with the energy that they had:
    only the collision with virtual particles, which are drawn at the wall's temperature, hands
    heat over. So the fluid is warmer than the wall by jump dT/dy, as if the wall lay that much
    deeper. Of the conductivity n (d + 2)/2 D_T, collisions carry
        k_col = d/(12 dt) sum P(N) (1 - r1) (1 - 1/N)
    within cells, and of a fluid at one temperature a wall takes 2 k_col times the difference.
    Flights carry the rest, q = k_kin/k_col times as much; within the cells that walls cut
        jump = q/2 + 1/7 + 0.0845/(1 + 1.355 q),
    a fit (0.0015) to the numerical solution of the exchange of heat within cells.

    Raises ValueError as `transport`, and for rules other than "srd" (at holds the temperature, of
    srd+a the conductivity is not known). Source: derived in docs/theory.md, molecular chaos.

    >>> found = heat_at_walls("srd", 3, 10, 0.1, angle=130)
    >>> round(found.conductivity, 3), round(found.jump, 3)
    (3.882, 0.489)
    """
    one_of(("srd",), rule=rule)
    known = transport(rule, dimension, density, timestep, angle, kT, mass)
    assert known.thermal_diffusivity is not None
    conductivity = density * (dimension + 2) / 2 * known.thermal_diffusivity
    n, p, kept, _ = cell_memory(dimension, density, angle, rule, "none")
    within = dimension * float(np.sum(p * (1 - kept) * (1 - 1 / n))) / (12 * timestep)
    flights = conductivity / within - 1
    least, more, fades = MILNE
    return HeatAtWalls(conductivity, flights / 2 + least + more / (1 + fades * flights))


def slit_temperature_rise(
    heat: ArrayLike,
    height: float,
    conductivity: ArrayLike,
    lower: float | None,
    upper: float | None,
) -> Array:
    """Steady rise of the temperature kT above that of the plates of a slit, (n,).

    Parameters:
        heat: (n,) what friction heats per volume and time, at n evenly spaced heights from plate
            to plate.
        height: distance of the plates in cells.
        conductivity: heat flux over gradient of kT, one number or (n,).
        lower, upper: length of the jump at each plate in cells, None for a plate that takes no
            heat (a slip plate, or one without virtual particles).

    Raises ValueError for a height, conductivity or jump out of range, fewer than 2 heights, and
    two plates that take no heat. Source: Fourier's law, by the trapezoidal rule; at a plate the
    rise is jump times the gradient.

    A flow driven by a force has heat (rho g)^2 (y - H/2)^2/eta, and with h = H/2 the mean rise
    (rho g)^2 h^3 (h/5 + jump)/(3 eta conductivity):

    >>> y = np.linspace(0, 10, 401)
    >>> rise = slit_temperature_rise((y - 5) ** 2, 10, 2.0, 0.5, 0.5)
    >>> round(float(rise[0]), 3), round(float(np.trapezoid(rise, y)) / 10, 2)
    (10.417, 31.25)
    """
    heat = np.asarray(heat, float)
    if heat.ndim != 1 or len(heat) < 2:
        raise ValueError(f"heat: expected values at 2 heights or more, not of shape {heat.shape}")
    if np.shape(conductivity) not in ((), heat.shape):
        raise ValueError(
            f"conductivity: expected one or {len(heat)} values, not of shape "
            f"{np.shape(conductivity)}"
        )
    positive(height=height, conductivity=float(np.min(conductivity)))
    k = np.broadcast_to(np.asarray(conductivity, float), heat.shape)
    jumps = [jump for jump in (lower, upper) if jump is not None]
    if not jumps:
        raise ValueError("lower = upper = None: no steady state; expected a plate that takes heat")
    if min(jumps) < 0:
        raise ValueError(f"lower = {lower!r}, upper = {upper!r}: expected jumps of at least 0")
    step = height / (len(heat) - 1)
    below = _integral(heat, step)  # what is heated below each height
    if lower is None:
        out = 0.0
    elif upper is None:
        out = below[-1]
    else:
        resistance = lower / k[0] + _integral(1 / k, step)[-1] + upper / k[-1]
        out = (upper * below[-1] / k[-1] + _integral(below / k, step)[-1]) / resistance
    gradient = (out - below) / k
    at_plate = lower * gradient[0] if lower is not None else 0.0
    rise = at_plate + _integral(gradient, step)
    if lower is None and upper is not None:
        rise += -upper * gradient[-1] - rise[-1]
    return np.asarray(rise)


def _integral(values: Array, step: float) -> Array:
    """From the first to each point, by the trapezoidal rule."""
    return np.concatenate([[0.0], np.cumsum((values[1:] + values[:-1]) * step / 2)])
