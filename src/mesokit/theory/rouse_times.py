"""Relaxation times of beads linked by springs, without hydrodynamic interaction."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit.theory._check import positive
from mesokit.theory.harmonic_spring import spring
from mesokit.theory.normal_modes import NormalModes


class RouseTimes(NamedTuple):
    """Relaxation times of the modes 1, 2, ..., slowest first, of two kinds.

    `mode` (normal-mode times): <X_p(t) X_p(0)> decays as exp(-t/mode[p - 1]); the end-to-end vector
    of a dimer does. `stress` (stress times): the stress, a product of two X_p, decays as
    exp(-t/stress[p - 1]), twice as fast. Moduli and velocity modes take stress times.
    """

    mode: NDArray[np.float64]
    stress: NDArray[np.float64]


def rouse_times(
    modes: NormalModes, friction: float, *, K: float | None = None, k: float | None = None
) -> RouseTimes:
    """Times zeta/(k eigenvalue_p) of the normal modes and, half of them, of the stress.

    Of a dimer zeta/2k = zeta/4K and zeta/4k = zeta/8K; of N springs in a row the stress times are
    zeta/(8 k sin^2(p pi/(2N + 2))).

    Parameters: `modes` of the molecule, as `linear_modes(N + 1)`; `friction` zeta of a bead, kT
    over its diffusion coefficient; the spring, see `spring`. Raises ValueError for a value out of
    range. Source: P. E. Rouse, J. Chem. Phys. 21, 1272 (1953), eq. (31); D. Toneian, diploma
    thesis, TU Wien (2015), eqs. (5.1.16), (5.1.48), which are stress times. Valid for beads whose
    inertia and hydrodynamic interaction do not count (times long against m/zeta).

    >>> from mesokit.theory import linear_modes
    >>> times = rouse_times(linear_modes(2), friction=17.9, K=1 / 6)
    >>> times.mode.round(3).tolist(), times.stress.round(3).tolist()
    ([26.85], [13.425])
    """
    positive(friction=friction)
    mode = friction / (spring(K=K, k=k).k * modes.eigenvalues[1:])
    return RouseTimes(mode, mode / 2)


def rouse_times_from_slowest(
    modes: NormalModes, *, mode_time: float | None = None, stress_time: float | None = None
) -> RouseTimes:
    """All relaxation times from the slowest, which is what is measured.

    Parameters: `modes` of the molecule; the slowest time, as `mode_time` or as `stress_time`.
    Raises ValueError for both, none, or one not above 0. Source and range as `rouse_times`.

    >>> from mesokit.theory import linear_modes
    >>> rouse_times_from_slowest(linear_modes(3), mode_time=3).stress.round(12).tolist()
    [1.5, 0.5]
    """
    if mode_time is None and stress_time is not None:
        positive(stress_time=stress_time)
        slowest = 2 * stress_time
    elif stress_time is None and mode_time is not None:
        positive(mode_time=mode_time)
        slowest = mode_time
    else:
        raise ValueError(f"mode_time = {mode_time!r}, stress_time = {stress_time!r}: expected one")
    mode = slowest * modes.eigenvalues[1] / modes.eigenvalues[1:]
    return RouseTimes(mode, mode / 2)
