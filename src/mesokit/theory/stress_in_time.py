"""Stress of Rouse molecules in a shear that changes in time: start-up, cessation, steps, ramps."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative
from mesokit.theory.relaxation_modulus import checked_times

Array = NDArray[np.float64]


class StressInTime(NamedTuple):
    """Means over intervals of time: `shear` stress, that of the `molecules` alone, and the `first`
    normal-stress difference sigma_xx - sigma_yy, tension positive; each (n,)."""

    shear: Array
    molecules: Array
    first: Array


def stress_in_time(
    time: ArrayLike,
    strain: ArrayLike,
    modulus: float,
    stress_times: ArrayLike,
    viscosity: float = 0.0,
) -> StressInTime:
    """Stress of a fluid of Rouse molecules, at rest until the first time, in any uniform shear.

    The shear stress is eta rate(t) + int G(t - t') rate(t') dt', with the relaxation modulus
    G(t) = phi kT sum_p exp(-t/tau_p); the normal stress of each mode follows from
    dN_p/dt = 2 rate sigma_p - N_p/tau_p. Both are integrated exactly for a shear rate that is even
    between two times.

    Parameters
    ----------
    time: (n + 1,) growing, where intervals end; what the rate is within one is averaged over.
    strain: (n + 1,) since whenever, the integral of the shear rate.
    modulus: phi kT, phi the number of molecules a volume.
    stress_times: tau_p, see `rouse_times`; () for a fluid without molecules.
    viscosity: eta, dynamic, of the fluid without its bonds.

    Raises ValueError for a value out of range. Source: R. B. Bird, C. F. Curtiss, R. C. Armstrong
    and O. Hassager, Dynamics of Polymeric Liquids 2 (1987), chapters 13 and 15: Rouse molecules
    are upper-convected Maxwell fluids, one for each mode. Valid as `maxwell_shear`. The shear
    stress is linear in the shear rate: where the flow is not uniform yet, its mean over the box
    follows from the mean shear rate. The normal stress is quadratic, and then larger.

    >>> t = np.linspace(0, 100, 1001)  # start-up
    >>> found = stress_in_time(t, 0.1 * t, modulus=5, stress_times=[10], viscosity=8)
    >>> [round(float(curve[-1]), 3) for curve in found]  # as in steady shear
    [5.8, 5.0, 9.995]
    """
    tau = checked_times(modulus, stress_times, viscosity)[:, None]
    not_negative(viscosity=viscosity)
    t, gamma = np.asarray(time, dtype=float), np.asarray(strain, dtype=float)
    if t.ndim != 1 or t.shape != gamma.shape or np.any(np.diff(t) <= 0):
        raise ValueError(f"time, strain: expected growing times, not {t.shape} and {gamma.shape}")
    rate = np.diff(gamma) / np.diff(t)
    x = np.diff(t) / tau  # (modes, intervals)
    left = np.exp(-x)
    mean = -np.expm1(-x) / x  # of exp(-s/tau) over an interval
    # that of s/tau exp(-s/tau); where intervals are short its series, as the difference cancels
    first_mean = np.where(x < 1e-3, x / 2 - x**2 / 3, (mean - left))
    steady = modulus * tau * rate
    steady_first = 2 * tau * rate * steady
    sigma, normal = np.zeros(len(tau)), np.zeros(len(tau))
    molecules, first = np.zeros(len(rate)), np.zeros(len(rate))
    for i in range(len(rate)):
        away, ahead = sigma - steady[:, i], normal - steady_first[:, i]
        driven = 2 * tau[:, 0] * rate[i] * away
        molecules[i] = (steady[:, i] + away * mean[:, i]).sum()
        first[i] = (steady_first[:, i] + ahead * mean[:, i] + driven * first_mean[:, i]).sum()
        sigma = steady[:, i] + away * left[:, i]
        normal = steady_first[:, i] + (ahead + driven * x[:, i]) * left[:, i]
    return StressInTime(viscosity * rate + molecules, molecules, first)
