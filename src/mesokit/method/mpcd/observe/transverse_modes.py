"""Decay of transverse velocity modes, and the viscosity that it gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mesokit import theory
from mesokit.case.component import component, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.expected.molecules import (
    free_bond,
    modes_of,
    rouse_note,
    rouse_times_of,
    without_bonds,
)
from mesokit.method.mpcd.expected.selection import molecule_of
from mesokit.method.mpcd.molecule import FLUID
from mesokit.method.mpcd.observe.shared.decay import fit_curve, largest_error, normalised
from mesokit.method.mpcd.observe.shared.modes import (
    SHOWN,
    Modes,
    ModesAccumulator,
    transverse_units,
)
from mesokit.observe.shared.fitted import fitted_number
from mesokit.seam.estimate import Estimate
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Array, Comparison, Result

if TYPE_CHECKING:
    pass

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


LOWEST = (0.5, 0.2)  # of the correlation, that the fit looks at: later lags add little but noise
FEWEST = 4  # lags; the lower limit serves where the sampling is too coarse for the upper one
DROWNED = 2.0  # standard errors below which a correlation has drowned in noise
FITTED = 3  # wave numbers of a fluid of molecules that are fitted
FIRST = 3  # steps left out of the fit: the first collisions do not obey hydrodynamics yet


@component
class TransverseModes(Modes):
    """Correlation in time of velocity modes across their wave vector, averaged over equal length.

    It decays as exp(-nu k^2 t): each wave number gives a viscosity.
    """

    quantity: Literal["transverse-modes"] = tag("transverse-modes")


def decaying(time: Array, rate: float, amplitude: float) -> Array:
    """An exponential."""
    return np.asarray(amplitude * np.exp(-rate * time))


@accumulator_of(TransverseModes)
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
        bonded = self.case.fluid.molecule is not None
        fits = self.viscosities(coefficients)
        if bonded:
            fits = self.bonded_fits() + self.deviations()
        return Result(
            quantity="transverse-modes",
            drawing="modes",
            name=self.name,
            x={"time": time, "wavenumber": self.wavenumbers},
            value=value,
            error=error,
            label="transverse mode correlation",
            units={"value": "", "time": "tau", "wavenumber": "1/a"},
            expected=self.law(time),
            theory="Rouse fluid at finite k" if bonded else "exp(-nu k^2 t)",
            comparisons=tuple([c for c in [*fits, first] if c]),
            samples=self.shells[0].correlator.count,
            extra=self.smooth(time),
        )

    def law(self, time: Array) -> Array | None:
        """exp(-nu k^2 t), or what springs make of it."""
        if self.case.fluid.molecule is not None:
            return self.bonded_law(time) if self.undisturbed() else None
        coefficients = setting.transport(self.case) if self.undisturbed() else None
        if coefficients is None:
            return None
        return theory.transverse_correlation(
            self.wavenumbers, time[:, None], coefficients.viscosity
        )

    def bonded_law(self, time: Array, finite: bool = True) -> Array | None:
        """Of a fluid of Rouse molecules, at finite wave numbers or as for long waves."""
        case = self.case
        coefficients = without_bonds(case)
        times, bond = rouse_times_of(case, FLUID), free_bond(case, FLUID)
        if coefficients is None or times is None or bond is None:
            return None
        molecule, nu = molecule_of(case, kind=FLUID), coefficients.viscosity
        elasticity = case.fluid.kT / (case.fluid.mass * molecule.length)
        if not finite:
            return theory.transverse_correlation_chain(
                self.wavenumbers, time[:, None], nu, elasticity, times.stress
            )
        diffusion = coefficients.diffusion / molecule.length
        springs = theory.GaussianMolecule(
            modes_of(molecule), times.mode[0], bond, diffusion, case.box.dimension
        )
        curves = [
            theory.transverse_correlation_finite_k(k, time, nu, elasticity, springs)
            for k in self.wavenumbers
        ]
        return np.stack(curves, axis=1)

    def bonded_fits(self) -> list[Comparison]:
        """Stress time of the slowest mode and background viscosity, from each of the longest waves.

        Fitted to the correlation of finite k up to where theory falls below noise.
        """
        case = self.case
        coefficients = without_bonds(case)
        times, bond = rouse_times_of(case, FLUID), free_bond(case, FLUID)
        if not self.undisturbed() or coefficients is None or times is None or bond is None:
            return []
        molecule, found = molecule_of(case, kind=FLUID), []
        springs = theory.GaussianMolecule(
            modes_of(molecule),
            times.mode[0],
            bond,
            coefficients.diffusion / molecule.length,
            case.box.dimension,
        )
        elasticity = case.fluid.kT / (case.fluid.mass * molecule.length)
        for k, _, correlator in self.shells[:FITTED]:
            lags, curve = normalised(correlator)
            time, law = lags * self.interval(), BondedLaw(k, elasticity, springs)
            start = (coefficients.viscosity, float(times.mode[0]))
            if len(time) < FEWEST:
                continue
            error = curve.error
            above = np.flatnonzero(np.abs(law(time, *start)) > DROWNED * error)
            use = np.arange(len(time)) <= (above[-1] if len(above) else 0)
            use &= lags * self.observable.every >= FIRST
            fitted = fit_bonded(time, curve, law, start, use)
            if fitted is None:
                continue
            nu, slowest = np.exp(fitted.value)
            for value, gradient, what, expected, unit, note in (
                (
                    slowest / 2, [0.0, slowest / 2], "stress time", times.stress[0], "tau",
                    rouse_note(case),
                ),
                (
                    nu, [nu, 0.0], "background viscosity", start[0], "a^2/tau",
                    "approximate: that of free particles",
                ),
            ):  # fmt: skip
                number, spread = fitted.scalar(float(value), np.array(gradient))
                name = f"{what} at k = {k:.4g}/a"
                found.append(fitted_number(name, number, spread, float(expected), unit, note))
        return found

    def deviations(self) -> list[Comparison]:
        """The largest from theory for each of the smallest wave numbers, above noise."""
        time, value, error = self.curves()
        found = []
        for finite, name in ((True, "finite k"), (False, "long waves")):
            if not self.undisturbed() or not len(time):
                break
            law = self.bonded_law(time, finite)
            if law is None:
                break
            for i, (k, _, correlator) in enumerate(self.shells[:SHOWN]):
                drowned = np.flatnonzero(~(np.abs(value[:, i]) > DROWNED * error[:, i]))
                end = drowned[drowned > FIRST][:1]
                _, curve = normalised(correlator)
                use = slice(0, min(int(end[0]) if len(end) else len(time), len(curve.value)))
                off = value[use, i] - law[use, i]
                worst = int(np.argmax(np.abs(off)))
                found.append(
                    Comparison(
                        f"largest deviation at k = {k:.4g}/a, {name}",
                        float(off[worst]),
                        largest_error(off, curve.part(use)),
                        0.0,
                        "",
                        f"at {time[worst]:.3g} tau",
                    )
                )
        return found

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
            what = f"viscosity at k = {k:.4g}/a"
            note = setting.caveat(self.case) or setting.chaos_is_off(self.case, expected, error)
            found.append(fitted_number(what, nu, error, expected, "a^2/tau", note))
        return found
