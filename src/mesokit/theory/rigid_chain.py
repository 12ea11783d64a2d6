"""Waves in a chain of rigid grains, whose solver stops after some sweeps."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import one_of, positive
from mesokit.theory.sweeps import Order, sweep_factor, sweep_spread


class RigidChain(NamedTuple):
    """Speed of long waves, stiffness of a contact, and the shortest wave that oscillates."""

    speed: float
    stiffness: float
    shortest: float


def rigid_chain(
    sweeps: float, timestep: float, diameter: float, mass: float, order: Order = "random"
) -> RigidChain:
    """How a chain of rigid grains acts as an elastic one, as forces spread by sweeps.

    With n sweeps in each step, from the forces of the step before, and q of `sweep_spread`: waves
    with the speed d sqrt(q n)/dt, springs of stiffness m q n/dt^2, damping of the amplitude at the
    rate q n k^2/(2 dt), k per grain. In the limit of long waves; those shorter than pi sqrt(q n) d
    die before they swing. `rigid_chain_wave` has all waves.

    Parameters: `sweeps` n; `timestep` dt; `diameter` d, `mass` m of a grain; `order` of updates.
    Raises ValueError for numbers not above 0. Source: T. Unger, L. Brendel, D. E. Wolf and
    J. Kertesz, Phys. Rev. E 65, 061305 (2002).

    >>> [round(x, 3) for x in rigid_chain(20, 0.01, 1.0, 1.0)]
    [399.36, 159488.508, 12.546]
    """
    positive(sweeps=sweeps, timestep=timestep, diameter=diameter, mass=mass)
    spread = sweep_spread(order) * sweeps
    root = math.sqrt(spread)
    return RigidChain(
        diameter * root / timestep, mass * spread / timestep**2, math.pi * root * diameter
    )


class ChainWave(NamedTuple):
    """Angular frequency, and the rate at which the amplitude decays."""

    frequency: NDArray[np.float64]
    decay: NDArray[np.float64]


def rigid_chain_wave(
    wave_number: ArrayLike, sweeps: float, timestep: float, order: Order = "random"
) -> ChainWave:
    """Frequency and decay of a wave in a chain of rigid grains that press on one another.

    With s = f(k)^n, f of `sweep_factor`, a step takes forces to within s of those that stop the
    wave: the amplitude goes as s^(t/2 dt), the phase as arccos(sqrt(s)) t/dt (derived here).

    Parameters: `wave_number` k per grain, pi j/N for N grains between fixed walls (a contact with a
    wall moves one grain alone); `sweeps` n of a step, from the forces of the step before;
    `timestep`; `order` of updates, not `jacobi`. Raises ValueError for numbers out of range. Exact
    in long chains, all contacts closed; within 1 % from 60 grains.

    >>> wave = rigid_chain_wave(math.pi / 63, 5, 1.0)
    >>> round(float(wave.frequency), 5), round(float(wave.decay), 6)
    (0.09949, 0.004958)
    """
    positive(sweeps=sweeps, timestep=timestep)
    one_of(("random", "coloured", "ordered"), order=order)
    k = np.atleast_1d(np.asarray(wave_number, float))
    left = sweep_factor(wave_number, order) ** sweeps
    lost = k[~(np.atleast_1d(left) > 0)]
    if lost.size:
        raise ValueError(f"wave_number = {lost[0]:g}: expected waves of which sweeps leave a part")
    return ChainWave(
        np.asarray(np.arccos(np.sqrt(left)) / timestep),
        np.asarray(-np.log(left) / (2 * timestep)),
    )
