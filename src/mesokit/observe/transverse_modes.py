"""Decay of transverse velocity modes, and the viscosity that it gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from mesokit import theory
from mesokit.component import component, tag
from mesokit.observe import setting
from mesokit.observe.decay import fit_curve, normalised
from mesokit.observe.modes import SHOWN, Array, Modes, ModesAccumulator, transverse_units
from mesokit.observe.result import Comparison, Result

if TYPE_CHECKING:
    from mesokit.case import Case

LOWEST = (0.5, 0.2)  # of the correlation, that the fit looks at: later lags add little but noise
FEWEST = 4  # lags; the lower limit serves where the sampling is too coarse for the upper one
FIRST = 3  # steps left out of the fit: the first collisions do not obey hydrodynamics yet


@component
class TransverseModes(Modes):
    """Correlation in time of velocity modes across their wave vector, averaged over equal length.

    It decays as exp(-nu k^2 t): each wave number gives a viscosity.
    """

    quantity: Literal["transverse-modes"] = tag("transverse-modes")

    def accumulator(self, case: Case) -> TransverseModesAccumulator:
        """An empty memory for it."""
        return TransverseModesAccumulator(self, case)


def decaying(time: Array, rate: float, amplitude: float) -> Array:
    """An exponential."""
    return np.asarray(amplitude * np.exp(-rate * time))


class TransverseModesAccumulator(ModesAccumulator):
    """Correlators of the polarisations across each wave vector."""

    def polarise(self, wavevector: Array) -> Array:
        """Across it."""
        return transverse_units(wavevector)

    def result(self) -> Result:
        """The decay for each wave number, and the viscosity from each."""
        time, value, error = self.curves()
        coefficients = setting.transport(self.case) if self.undisturbed() else None
        first = self.equipartition() if self.undisturbed() else None
        fits = self.viscosities(coefficients)
        return Result(
            quantity="transverse-modes",
            name=self.name,
            x={"time": time, "wavenumber": self.wavenumbers},
            value=value,
            error=error,
            label="transverse mode correlation",
            units={"value": "", "time": "tau", "wavenumber": "1/a"},
            expected=self.law(time),
            theory="exp(-nu k^2 t)",
            comparisons=tuple([c for c in [*fits, first] if c]),
            samples=self.shells[0].correlator.count,
            extra=self.smooth(time),
        )

    def law(self, time: Array) -> Array | None:
        """exp(-nu k^2 t)."""
        coefficients = setting.transport(self.case) if self.undisturbed() else None
        if coefficients is None:
            return None
        return theory.transverse_correlation(
            self.wavenumbers, time[:, None], coefficients.viscosity
        )

    def viscosities(self, coefficients: theory.Transport | None) -> list[Comparison]:
        """One for each of the smallest wave numbers."""
        found = []
        for k, _, correlator in self.shells[:SHOWN]:
            lags, curve = normalised(correlator)
            time = lags * self.interval()
            for lowest in LOWEST:
                below = np.flatnonzero(~(curve.value > lowest))
                use = np.arange(len(time)) < (below[0] if len(below) else len(time))
                use &= lags * self.observable.every >= FIRST
                if use.sum() >= FEWEST:
                    break
            if use.sum() < 3:
                continue
            start = [-np.log(curve.value[use][-1]) / time[use][-1], 1.0]
            fitted = fit_curve(time, curve, decaying, start, use)
            if fitted is None:
                continue
            nu, error = fitted.scalar(fitted.value[0] / k**2, np.array([1 / k**2, 0]))
            expected = coefficients.viscosity if coefficients else np.nan
            what, note = f"viscosity at k = {k:.4g}/a", setting.caveat(self.case)
            found.append(Comparison(what, nu, error, expected, "a^2/tau", note))
        return found
