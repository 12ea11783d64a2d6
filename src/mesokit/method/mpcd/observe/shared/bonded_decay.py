"""Relaxation time and viscosity of a fluid of molecules from the decay of its velocity modes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.method.mpcd.observe.shared.decay import fit_curve
from mesokit.seam.estimate import Estimate
from mesokit.seam.result import Array

STEPS = 400  # of the law: its error is far below that of any fit


class BondedLaw(NamedTuple):
    """Velocity modes of a fluid of molecules, but for the viscosity and the slowest time."""

    wavenumber: float
    elasticity: float
    molecule: theory.GaussianMolecule

    def __call__(self, time: Array, viscosity: float, mode_time: float) -> Array:
        """The correlation (n,)."""
        molecule = self.molecule._replace(mode_time=mode_time)
        return theory.transverse_correlation_finite_k(
            self.wavenumber, time, viscosity, self.elasticity, molecule, STEPS
        )


def fit_bonded(
    time: Array, curve: Estimate, law: BondedLaw, start: tuple[float, float], use: NDArray[np.bool_]
) -> Estimate | None:
    """Logarithms of the viscosity and of the slowest mode time (2,), by least squares; None where
    there is no fit.

    Lags weigh alike, as in `fit_curve`: what each block of time adds to every lag is carried
    through the linearised fit, so that errors know how lags and samples are correlated.
    """

    def model(t: Array, log_viscosity: float, log_time: float) -> Array:
        # a search may stray far: keep it where the law has a meaning
        nu, tau = np.exp(np.clip([log_viscosity, log_time], -12.0, 16.0))
        return law(t, float(nu), float(tau))

    return fit_curve(time, curve, model, list(np.log(start)), use)
