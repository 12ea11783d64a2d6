"""Transverse velocity modes of a fluid made of Rouse chains of any length."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import positive
from mesokit.theory.relaxation_modulus import checked_times

Array = NDArray[np.float64]

MEETING = 1e3  # residues of two poles that meet grow beyond bounds and cancel


class TransversePoles(NamedTuple):
    """C(t) = sum of `residues` times exp(`poles` t): real, or at most one conjugate pair."""

    poles: NDArray[np.complex128]
    residues: NDArray[np.complex128]


def transverse_poles(
    k: float, viscosity: float, elasticity: float, stress_times: ArrayLike
) -> TransversePoles:
    """Poles and residues of the correlation of transverse velocity modes, slowest first.

    C(t) = [exp(A t)]_00 of the arrow matrix with -nu k^2, -1/tau_1, -1/tau_2, ... on its diagonal,
    -c in the rest of row 0, c in the rest of column 0, c^2 = k^2 phi kT/rho. With
    f(s) = s + nu k^2 + c^2 sum_p 1/(s + 1/tau_p), poles are the zeros of f, residues 1/f'. Between
    neighbouring -1/tau_p lies one real zero, so that no more than one pair is complex.

    Parameters: `k` wave number; `viscosity` nu, kinematic, of the fluid without bonds; `elasticity`
    phi kT/rho, kT/(n m) where every particle is in a chain of n; `stress_times` (N,) tau_p, see
    `rouse_times`. Raises ValueError for a value out of range. Source: D. Toneian, diploma thesis,
    TU Wien (2015), eq. (5.1.29); its solution (5.1.38) by coefficients of polynomials is off by
    3e-2 for 100 beads, where this, the eigenvalues of the matrix sharpened by Newton's method, is
    good to 1e-13. Where two poles meet, their residues grow beyond bounds
    (`transverse_correlation_chain` then takes the exponential itself). Valid for times above the
    timestep and waves longer than the chains.

    >>> poles, _ = transverse_poles(2 * np.pi / 30, 0.8705, 0.5, [13.4])
    >>> poles.round(4).tolist()
    [(-0.0564-0.147j), (-0.0564+0.147j)]
    """
    matrix = _arrow(k, viscosity, elasticity, stress_times)
    poles, v = np.linalg.eig(matrix)
    poles = _sharpened(poles, matrix)
    # the transposed matrix has the same eigenvectors with the sign of all but row 0 turned
    with np.errstate(divide="ignore", invalid="ignore"):
        residues = v[0] ** 2 / (v[0] ** 2 - (v[1:] ** 2).sum(axis=0))
    order = np.lexsort((poles.imag, -poles.real))
    return TransversePoles(poles[order].astype(complex), residues[order].astype(complex))


def _sharpened(poles: Array, matrix: Array) -> Array:
    """Poles after one step of Newton's method for f(s) = 0.

    Eigenvalues are off by the rounding of the largest of them, which is much for the slow ones.
    A step that is larger than that meets another pole, and is not made.
    """
    rates, squares = np.diag(matrix), matrix[1:, 0] ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        near = 1 / (poles[:, None] - rates[1:])
        value = poles - rates[0] + near @ squares
        step = value / (1 - near**2 @ squares)
    rounding = 100 * np.finfo(float).eps * np.abs(rates).max()
    return np.where(np.abs(step) < rounding, poles - step, poles)


def transverse_correlation_chain(
    k: ArrayLike, time: ArrayLike, viscosity: float, elasticity: float, stress_times: ArrayLike
) -> Array:
    """Normalised autocorrelation of a transverse Fourier mode of the velocity of a Rouse fluid.

    Parameters: `k` wave numbers and `time` delays of 0 or more, shapes that broadcast; the others,
    errors, source and range as in `transverse_poles`.

    >>> from mesokit.theory import linear_modes, rouse_times_from_slowest
    >>> times = rouse_times_from_slowest(linear_modes(10), stress_time=26.8).stress
    >>> t = np.array([5.0, 10, 20])
    >>> transverse_correlation_chain(2 * np.pi / 30, t, 0.8705, 0.1, times).round(5).tolist()
    [0.6333, 0.26826, -0.09251]
    """
    k, t = np.broadcast_arrays(np.asarray(k, dtype=float), np.asarray(time, dtype=float))
    if np.any(t < 0):
        raise ValueError(f"time = {time!r}: expected 0 or more")
    result = np.empty(t.shape)
    for wave in np.unique(k):
        here = k == wave
        poles, residues = transverse_poles(float(wave), viscosity, elasticity, stress_times)
        if np.abs(residues).max() < MEETING:
            result[here] = (np.exp(t[here][:, None] * poles) @ residues).real
        else:
            # slower, but without the residues of two poles that meet
            from scipy.linalg import expm

            matrix = _arrow(float(wave), viscosity, elasticity, stress_times)
            result[here] = [expm(matrix * delay)[0, 0] for delay in t[here]]
    return result


def _arrow(k: float, viscosity: float, elasticity: float, stress_times: ArrayLike) -> Array:
    """The matrix A of `transverse_poles`."""
    positive(viscosity=viscosity, elasticity=elasticity)
    tau = np.sort(checked_times(elasticity, stress_times))[::-1]
    # times that differ, and how often each is there: those of a ring come in pairs
    start = np.append(True, tau[1:] < tau[:-1] * (1 - 1e-12))
    count = np.diff(np.append(np.flatnonzero(start), len(tau))).astype(float)
    tau = tau[start]
    matrix = -np.diag(np.append(viscosity * k * k, 1 / tau))
    matrix[0, 1:] = -k * np.sqrt(elasticity * count)
    matrix[1:, 0] = k * np.sqrt(elasticity * count)
    return matrix
