"""Linear viscoelasticity of Rouse molecules in a viscous fluid: a sum of Maxwell modes."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, positive

Array = NDArray[np.float64]


def relaxation_modulus(time: ArrayLike, modulus: float, stress_times: ArrayLike) -> Array:
    """Relaxation modulus G(t) = phi kT sum_p exp(-t/tau_p) of the molecules, t > 0.

    The fluid around them adds 2 eta delta(t), all of whose weight lies in an integral from 0 on.

    Parameters: `time` 0 or more, any shape; `modulus` phi kT, phi the number of molecules a volume;
    `stress_times` (n,) tau_p, see `rouse_times`. Raises ValueError for a value out of range.
    Source: D. Toneian, diploma thesis, TU Wien (2015), eq. (5.1.26), whose delta lacks the 2. Valid
    for Rouse molecules, dilute or bonded fluids, and waves longer than they are.

    >>> round(float(relaxation_modulus(13.4, 5, [13.4])), 6)
    1.839397
    """
    tau = checked_times(modulus, stress_times)
    t = np.asarray(time, dtype=float)
    if np.any(t < 0):
        raise ValueError(f"time = {time!r}: expected 0 or more")
    return np.asarray(modulus * np.exp(-t[..., None] / tau).sum(axis=-1))


def storage_modulus(frequency: ArrayLike, modulus: float, stress_times: ArrayLike) -> Array:
    """Storage modulus G'(w) = phi kT sum_p (w tau_p)^2/(1 + (w tau_p)^2).

    Parameters: `frequency` w, radians per time, any shape; the others as in `relaxation_modulus`.
    Raises ValueError for a value out of range. Source: P. E. Rouse, J. Chem. Phys. 21, 1272
    (1953), eq. (30a); Toneian (2015), eq. (5.1.14). Valid as `relaxation_modulus`.

    >>> float(storage_modulus(0.1, 5, [10]))
    2.5
    """
    tau = checked_times(modulus, stress_times)
    x = np.asarray(frequency, dtype=float)[..., None] * tau
    return np.asarray(modulus * (x**2 / (1 + x**2)).sum(axis=-1))


def loss_modulus(
    frequency: ArrayLike, modulus: float, stress_times: ArrayLike, viscosity: float = 0.0
) -> Array:
    """Loss modulus G''(w) = w eta + phi kT sum_p w tau_p/(1 + (w tau_p)^2).

    Parameters: as in `storage_modulus`; `viscosity` eta, dynamic, of the fluid without its bonds.
    Raises ValueError for a value out of range. Source: Rouse (1953), eq. (30b); Toneian (2015),
    eq. (5.1.15). Valid as `relaxation_modulus`.

    >>> float(loss_modulus(0.1, 5, [10], viscosity=8))
    3.3
    """
    tau = checked_times(modulus, stress_times, viscosity)
    w = np.asarray(frequency, dtype=float)
    x = w[..., None] * tau
    return np.asarray(w * viscosity + modulus * (x / (1 + x**2)).sum(axis=-1))


def complex_viscosity(
    frequency: ArrayLike, modulus: float, stress_times: ArrayLike, viscosity: float = 0.0
) -> NDArray[np.complex128]:
    """Complex viscosity eta* = eta + phi kT sum_p tau_p/(1 + i w tau_p) = (G' + i G'')/(i w).

    Parameters, errors and range as in `loss_modulus`. Source: Toneian (2015), eq. (5.1.24); the
    flow goes as exp(i w t), so that its imaginary part is -G'/w.

    >>> complex(complex_viscosity(0.1, 5, [10], viscosity=8))
    (33-25j)
    """
    tau = checked_times(modulus, stress_times, viscosity)
    w = np.asarray(frequency, dtype=float)
    return np.asarray(viscosity + modulus * (tau / (1 + 1j * w[..., None] * tau)).sum(axis=-1))


def apparent_viscosity(viscosity: float, modulus: float, stress_times: ArrayLike) -> float:
    """Viscosity eta + phi kT sum_p tau_p of slow flows and at long times.

    Parameters: as in `loss_modulus`; also all kinematic, nu and phi kT/rho. Raises ValueError for a
    value out of range. Source: integral of G(t); D. Toneian (2015), eq. (5.1.63) for dimers.
    Valid at any shear rate for Hookean springs; in the decay of velocity modes, for wave numbers
    far below the lower end of `dimer_oscillation_range`.

    >>> apparent_viscosity(8.705, 5, [13.4])
    75.705
    """
    tau = checked_times(modulus, stress_times, viscosity)
    return viscosity + modulus * float(tau.sum())


def checked_times(modulus: float, stress_times: ArrayLike, viscosity: float = 0.0) -> Array:
    """Stress times as an array, all arguments in range."""
    positive(modulus=modulus)
    not_negative(viscosity=viscosity)
    tau = np.atleast_1d(np.asarray(stress_times, dtype=float))
    if tau.ndim != 1 or not np.all((tau > 0) & np.isfinite(tau)):
        raise ValueError(f"stress_times = {stress_times!r}: expected finite numbers above 0")
    return tau
