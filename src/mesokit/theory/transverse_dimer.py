"""Transverse velocity modes of a fluid made of dimers."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, positive

Array = NDArray[np.float64]


def transverse_correlation_dimer(
    k: ArrayLike,
    time: ArrayLike,
    viscosity: float,
    elasticity: float,
    stress_time: float,
    bond_squared: float = 0.0,
    centre_diffusion: float = 0.0,
    dimension: int = 3,
) -> Array:
    """Normalised autocorrelation of a transverse Fourier mode of the velocity of a dimer fluid.

    The solution of C' = -nu k^2 C - c^2 int_0^t exp(-(t - s)/tau) C(s) ds, c^2 = k^2 phi kT/rho:
    with p = -(1/tau + nu k^2)/2 and w^2 = (nu k^2/tau + c^2) - p^2,

        exp(p t) [cos w t + (1/tau + p) sin(w t)/w]     where w^2 > 0, it oscillates,
        the same with cosh and sinh of |w|              elsewhere, it is overdamped.

    Parameters:
        k: wave numbers; time: delays, 0 or more, shapes that broadcast.
        viscosity: nu, kinematic, of the same fluid without bonds.
        elasticity: phi kT/rho, a velocity squared; kT/2m where every particle is in a dimer.
        stress_time: tau, half the time in which the end-to-end vector relaxes.
        bond_squared, centre_diffusion: mean square bond length l^2 and diffusion coefficient of the
            dimer's centre (half that of a bead). With them the form for finite k: elasticity times
            exp(-k^2 l^2/4d), rate 1/tau + k^2 D_centre.
        dimension: d of space, for that form.

    Raises ValueError for a value out of range. Source: D. Toneian, diploma thesis, TU Wien (2015),
    eqs. (5.1.57), (5.1.59); finite k derived in docs/theory-polymers.md. Valid for times above the
    timestep and k l below 1; in a simulation of l = 3 and L = 30 the largest deviation was 0.025,
    with finite k 0.010.

    >>> t = np.array([5.0, 10, 20])
    >>> transverse_correlation_dimer(2 * np.pi / 30, t, 0.8705, 0.5, 13.4).round(5).tolist()
    [0.6223, 0.12758, -0.30899]
    """
    positive(viscosity=viscosity, elasticity=elasticity, stress_time=stress_time)
    positive(dimension=dimension)
    not_negative(bond_squared=bond_squared, centre_diffusion=centre_diffusion)
    k, t = np.broadcast_arrays(np.asarray(k, dtype=float), np.asarray(time, dtype=float))
    if np.any(t < 0):
        raise ValueError(f"time = {time!r}: expected 0 or more")
    k2 = k * k
    rate = 1 / stress_time + k2 * centre_diffusion
    c2 = k2 * elasticity * np.exp(-k2 * bond_squared / (4 * dimension))
    p = -(rate + viscosity * k2) / 2
    product = viscosity * k2 * rate + c2
    # p^2 - product, without the cancellation
    discriminant = ((rate - viscosity * k2) / 2) ** 2 - c2
    w = np.sqrt(np.abs(discriminant))
    waves = np.exp(p * t) * (np.cos(w * t) + (rate + p) * t * np.sinc(w * t / np.pi))
    fast = p - w
    slow = product / fast  # p + w, without the cancellation
    with np.errstate(divide="ignore", invalid="ignore"):
        difference = np.where(w * t > 0, -np.expm1(-2 * w * t) / (2 * w), t)
    damped = np.exp(slow * t) * (1 + (rate + fast) * difference)
    return np.asarray(np.where(discriminant < 0, waves, damped))


def dimer_oscillation_range(
    viscosity: float, elasticity: float, stress_time: float
) -> tuple[float, float]:
    """Wave numbers between which transverse velocity modes of a dimer fluid oscillate.

    (sqrt(c0^2 + nu/tau) -+ c0)/nu, c0^2 = phi kT/rho.

    Parameters, errors as in `transverse_correlation_dimer`. Source: the zeros of w^2 there, from
    D. Toneian (2015), eq. (5.1.58). Valid without the terms of finite k.

    >>> low, high = dimer_oscillation_range(0.8705, 0.5, 13.4)
    >>> round(low, 4), round(high, 3)
    (0.0512, 1.676)
    """
    positive(viscosity=viscosity, elasticity=elasticity, stress_time=stress_time)
    c0 = math.sqrt(elasticity)
    high = (math.sqrt(elasticity + viscosity / stress_time) + c0) / viscosity
    return 1 / (viscosity * stress_time * high), high
