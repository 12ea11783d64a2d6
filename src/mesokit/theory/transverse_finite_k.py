"""Transverse velocity modes of bonded fluids at waves as short as the molecules are long."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mesokit.theory._check import not_negative, positive, whole
from mesokit.theory.normal_modes import NormalModes

Array = NDArray[np.float64]


class GaussianMolecule(NamedTuple):
    """A molecule of springs without rest length, by Rouse dynamics.

    modes: as `linear_modes(10)`. mode_time: slowest time of its normal modes, twice the slowest
    stress time. bond_squared: <b^2> of a free bond, see `mean_square_bond`. centre_diffusion:
    diffusion coefficient of its centre of mass. dimension: of space.
    """

    modes: NormalModes
    mode_time: float
    bond_squared: float
    centre_diffusion: float = 0.0
    dimension: int = 3


def gaussian_stress_kernel(k: float, time: ArrayLike, molecule: GaussianMolecule) -> Array:
    """Relaxation modulus G(k, t)/(phi kT) of Gaussian molecules at a finite wave number.

    For k = 0 the sum of exp(-t/tau_p) over the stress times. The Fourier mode of the stress is that
    of the spring forces over i k, so that with the component s^2 = <b^2>/d of a bond, the
    connectivity matrix L, r = 1/(mode_time eigenvalue_1) and positions y along the wave,

        G/(phi kT) = sum_ij [L exp(-r L t)]_ij exp(-k^2 <(y_i(t) - y_j(0))^2>/2)/(k s)^2.

    Parameters:
        k: wave number above 0; time: delays, 0 or more, any shape; molecule: what it is made of.

    Raises ValueError for a value out of range. Source: derived in docs/theory-polymers.md. Exact
    for Rouse dynamics of springs without rest length. Of dimers exp(-q) sinh(q e)/q e exp(-k^2 D
    t), e = exp(-t/mode_time), q = k^2 <b^2>/4d, next to which the form of
    `transverse_correlation_dimer` leaves out q^2/6.

    >>> from mesokit.theory import linear_modes
    >>> dimer = GaussianMolecule(linear_modes(2), mode_time=26.8, bond_squared=9)
    >>> gaussian_stress_kernel(0.3, [0, 10], dimer).round(5).tolist()
    [0.93544, 0.44334]
    """
    modes, mode_time, bond_squared, centre_diffusion, dimension = molecule
    positive(k=k, mode_time=mode_time, bond_squared=bond_squared, dimension=dimension)
    not_negative(centre_diffusion=centre_diffusion)
    t = np.asarray(time, dtype=float)
    if np.any(t < 0):
        raise ValueError(f"time = {time!r}: expected 0 or more")
    stiffness, v = modes.eigenvalues[1:], modes.vectors[:, 1:]
    s2 = bond_squared / dimension
    own = (v**2 / stiffness).sum(axis=1)  # <y_i^2>/s2 about the centre of mass
    decay = np.exp(-np.multiply.outer(t, stiffness / stiffness[0]) / mode_time)
    elastic = np.empty(t.shape)
    for place in np.ndindex(t.shape):  # one time after the other: n^2 numbers each
        spread = own[:, None] + own - 2 * (v * (decay[place] / stiffness)) @ v.T
        forces = (v * (decay[place] * stiffness)) @ v.T
        elastic[place] = (forces * np.exp(-k * k * s2 / 2 * spread)).sum() / (k * k * s2)
    return elastic * np.exp(-k * k * centre_diffusion * t)


def transverse_correlation_finite_k(
    k: float,
    time: ArrayLike,
    viscosity: float,
    elasticity: float,
    molecule: GaussianMolecule,
    steps: int = 1000,
) -> Array:
    """Normalised autocorrelation of a transverse velocity mode, with the kernel for finite k.

    The solution of C' = -nu k^2 C - k^2 phi kT/rho int_0^t G(k, t - s)/(phi kT) C(s) ds.

    Parameters: `k` wave number above 0; `time` delays, 0 or more, any shape; `viscosity` nu,
    kinematic, and `elasticity` phi kT/rho as in `transverse_poles`; `molecule` as in
    `gaussian_stress_kernel`; `steps` of the solution up to the latest time, to be shorter than the
    fastest stress time. Raises ValueError for a value out of range. Source: D. Toneian, diploma
    thesis, TU Wien (2015), eq. (5.1.7), with the kernel derived in docs/theory-polymers.md;
    trapezoidal rule, extrapolated from `steps` and twice as many. Valid for times above the
    timestep and k below 1 in cells.

    >>> from mesokit.theory import linear_modes
    >>> dimer = GaussianMolecule(linear_modes(2), mode_time=26.8, bond_squared=9)
    >>> transverse_correlation_finite_k(
    ...     2 * np.pi / 30, [5.0, 10, 20], 0.8705, 0.5, dimer
    ... ).round(4).tolist()
    [0.6286, 0.1423, -0.3034]
    """
    positive(viscosity=viscosity, elasticity=elasticity)
    whole(10, steps=steps)
    t = np.asarray(time, dtype=float)
    if t.size == 0 or not t.max() > 0:
        return np.ones(t.shape)
    from scipy.interpolate import CubicSpline

    grid = np.linspace(0, t.max(), 2 * steps + 1)
    kernel = k * k * elasticity * gaussian_stress_kernel(k, grid, molecule)
    damping = viscosity * k * k
    coarse = _solve(kernel[::2], damping, grid[2])
    fine = _solve(kernel, damping, grid[1])[::2]
    return np.asarray(CubicSpline(grid[::2], fine + (fine - coarse) / 3)(t))


def _solve(kernel: Array, damping: float, step: float) -> Array:
    """C' = -damping C - kernel * C from 1 on, by the trapezoidal rule for both."""
    c = np.ones(len(kernel))
    implicit = 1 + step * damping / 2 + step**2 * kernel[0] / 4
    before = 0.0  # the convolution at the step before
    for n in range(1, len(kernel)):
        past = step * (kernel[n] * c[0] / 2 + kernel[n - 1 : 0 : -1] @ c[1:n])
        c[n] = (c[n - 1] * (1 - step * damping / 2) - step / 2 * (before + past)) / implicit
        before = past + step * kernel[0] * c[n] / 2
    return c
