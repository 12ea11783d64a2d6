"""Decay of transverse velocity modes, and the viscosity that it gives."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal, NamedTuple

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
from mesokit.method.mpcd.observe.shared.decay import (
    FEWEST,
    fit_curve,
    fit_decay,
    largest_error,
    normalised,
)
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


DROWNED = 2.0  # standard errors below which a correlation has drowned in noise
FITTED = 3  # wave numbers of a fluid of molecules that are fitted
FIRST = 3  # steps left out of the fit: the first collisions do not obey hydrodynamics yet


@component
class TransverseModes(Modes):
    """Correlation in time of velocity modes across their wave vector, averaged over equal length.

    It decays as exp(-nu k^2 t): each wave number gives a viscosity.
    """

    quantity: Literal["transverse-modes"] = tag("transverse-modes")
    drawing = "modes"
    value_label = "transverse mode correlation"
    units: ClassVar[dict[str, str]] = {"time": "tau", "wavenumber": "1/a"}


@accumulator_of(TransverseModes)
class TransverseModesAccumulator(ModesAccumulator):
    """Correlators of the polarisations across each wave vector."""

    def polarise(self, wavevector: Array) -> Array:
        return transverse_units(wavevector)

    def result(self) -> Result:
        if self.case.fluid.molecule is None:
            return self.modes(self.viscosities(), "exp(-nu k^2 t)")
        return self.modes([*self.bonded_fits(), *self.deviations()], "Rouse fluid at finite k")

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

    def springs(self) -> tuple[BondedLaw, theory.Transport, theory.RouseTimes] | None:
        """Of a fluid of Rouse molecules: the law at the first wave number, coefficients without
        bonds, and times; None without a theory."""
        case = self.case
        coefficients = without_bonds(case)
        times, bond = rouse_times_of(case, FLUID), free_bond(case, FLUID)
        if coefficients is None or times is None or bond is None:
            return None
        molecule = molecule_of(case, kind=FLUID)
        diffusion, d = coefficients.diffusion / molecule.length, case.box.dimension
        springs = theory.GaussianMolecule(modes_of(molecule), times.mode[0], bond, diffusion, d)
        elasticity = case.fluid.kT / (case.fluid.mass * molecule.length)
        return BondedLaw(self.wavenumbers[0], elasticity, springs), coefficients, times

    def bonded_law(self, time: Array, finite: bool = True) -> Array | None:
        """Of a fluid of Rouse molecules, at finite wave numbers or as for long waves."""
        known = self.springs()
        if known is None:
            return None
        (_, elasticity, springs), coefficients, times = known
        nu = coefficients.viscosity
        if not finite:
            return theory.transverse_correlation_chain(
                self.wavenumbers, time[:, None], nu, elasticity, times.stress
            )
        curves = [
            theory.transverse_correlation_finite_k(k, time, nu, elasticity, springs)
            for k in self.wavenumbers
        ]
        return np.stack(curves, axis=1)

    def bonded_fits(self) -> Iterator[Comparison]:
        """Stress time of the slowest mode and background viscosity, from each of the longest waves.

        Fitted to the correlation of finite k up to where theory falls below noise.
        """
        known = self.springs() if self.undisturbed() else None
        if known is None:
            return
        law, coefficients, times = known
        start = (coefficients.viscosity, float(times.mode[0]))
        for k, correlator in self.shells[:FITTED]:
            lags, curve = normalised(correlator)
            time, law = lags * self.interval(), law._replace(wavenumber=k)
            if len(time) < FEWEST:
                continue
            above = np.flatnonzero(np.abs(law(time, *start)) > DROWNED * curve.error)
            use = np.arange(len(time)) <= (above[-1] if len(above) else 0)
            use &= lags * self.observable.every >= FIRST
            fitted = fit_bonded(time, curve, law, start, use)
            if fitted is None:
                continue
            nu, slowest = np.exp(fitted.value)
            at, free = f"at k = {k:.4g}/a", "approximate: that of free particles"
            half = fitted.scalar(slowest / 2, np.array([0.0, slowest / 2]))
            expected, note = float(times.stress[0]), rouse_note(self.case)
            yield fitted_number(f"stress time {at}", *half, expected, "tau", note)
            found = fitted.scalar(nu, np.array([nu, 0.0]))
            yield fitted_number(f"background viscosity {at}", *found, start[0], "a^2/tau", free)

    def deviations(self) -> Iterator[Comparison]:
        """The largest from theory for each of the smallest wave numbers, above noise."""
        time, every = self.curves()
        if not self.undisturbed() or not len(time):
            return
        for finite, name in ((True, "finite k"), (False, "long waves")):
            law = self.bonded_law(time, finite)
            if law is None:
                return
            for i, (k, correlator) in enumerate(self.shells[:SHOWN]):
                value, error = every[i].value, every[i].error
                drowned = np.flatnonzero(~(np.abs(value) > DROWNED * error))
                end = drowned[drowned > FIRST][:1]
                _, curve = normalised(correlator)
                use = slice(0, min(int(end[0]) if len(end) else len(time), len(curve.value)))
                off = value[use] - law[use, i]
                worst = int(np.argmax(np.abs(off)))
                what, spread = f"largest deviation at k = {k:.4g}/a, {name}", curve.part(use)
                note = f"at {time[worst]:.3g} tau"
                yield Comparison(what, off[worst], largest_error(off, spread), 0.0, "", note)

    def viscosities(self) -> Iterator[Comparison]:
        """One for each of the smallest wave numbers."""
        coefficients = setting.transport(self.case) if self.undisturbed() else None
        expected = coefficients.viscosity if coefficients else np.nan
        for k, correlator in self.shells[:SHOWN]:
            lags, curve = normalised(correlator)
            late = lags * self.observable.every >= FIRST
            fitted = fit_decay(lags * self.interval(), curve, late)
            if fitted is None:
                continue
            nu, error = fitted.scalar(fitted.value[0] / k**2, np.array([1 / k**2, 0]))
            what = f"viscosity at k = {k:.4g}/a"
            note = setting.caveat(self.case) or setting.chaos_is_off(self.case, expected, error)
            yield fitted_number(what, nu, error, expected, "a^2/tau", note)
