"""Sound: velocity modes along their wave vector, their frequency and damping."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np

from mesokit.case.component import component, tag
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.observe.shared.decay import fit_curve, normalised
from mesokit.method.mpcd.observe.shared.modes import SHOWN, Array, Modes, ModesAccumulator
from mesokit.observe.shared.fitted import fitted_number
from mesokit.seam.observable import accumulator_of
from mesokit.seam.result import Comparison, Result

FIRST = 3  # steps left out of the fit, as for transverse modes
LONGEST = 2.5  # periods that the fit looks at


@component
class LongitudinalModes(Modes):
    """Correlation in time of velocity modes along their wave vector, averaged over equal length.

    It oscillates at the frequency of sound and is damped as exp(-Gamma k^2 t/2).
    """

    quantity: Literal["longitudinal-modes"] = tag("longitudinal-modes")
    asks_transport: ClassVar[bool] = True
    drawing = "modes"
    value_label = "longitudinal mode correlation"
    units: ClassVar[dict[str, str]] = {"time": "tau", "wavenumber": "1/a"}


def ringing(time: Array, damping: float, frequency: float, amplitude: float, sine: float) -> Array:
    wave = amplitude * np.cos(frequency * time) + sine * np.sin(frequency * time)
    return np.asarray(np.exp(-damping * time) * wave)


@accumulator_of(LongitudinalModes)
class LongitudinalModesAccumulator(ModesAccumulator):
    """Correlators of the momentum along each wave vector."""

    def polarise(self, wavevector: Array) -> Array:
        return (wavevector / np.linalg.norm(wavevector))[None]

    def result(self) -> Result:
        return self.modes(self.fits(), "damped sound")

    def law(self, time: Array) -> Array | None:
        coefficients = setting.transport(self.case) if self.undisturbed() else None
        if coefficients is None or coefficients.sound_attenuation is None:
            return None
        speed, attenuation = coefficients.sound_speed, coefficients.sound_attenuation
        return np.stack([self.sound(time, k, speed, attenuation) for k in self.wavenumbers], axis=1)

    @staticmethod
    def sound(time: Array, k: float, speed: float, attenuation: float) -> Array:
        """exp(-at) (cos wt - (a/w) sin wt), a = Gamma k^2/2, w^2 = c^2 k^2 - a^2.

        Exact in linear isothermal hydrodynamics; with heat conduction the phase is another, of
        the same small order. Overdamped beyond k = 2 c/Gamma.
        """
        damping = attenuation * k * k / 2
        frequency = np.emath.sqrt((speed * k) ** 2 - damping**2)
        wave = np.cos(frequency * time) - damping / frequency * np.sin(frequency * time)
        return np.asarray(np.real(np.exp(-damping * time) * wave))

    def fits(self) -> Iterator[Comparison]:
        """Sound speed and attenuation for each of the smallest wave numbers."""
        coefficients = setting.transport(self.case) if self.undisturbed() else None
        guess = coefficients.sound_speed if coefficients else self.case.fluid.kT**0.5
        damped = coefficients.sound_attenuation if coefficients else None
        known = damped if damped is not None else np.nan
        for k, correlator in self.shells[:SHOWN]:
            lags, curve = normalised(correlator)
            time = lags * self.interval()
            start_damping = (damped or 0.5) * k * k / 2
            reach = min(LONGEST * 2 * np.pi / (guess * k), 2 / start_damping)
            use = (time <= reach) & (lags * self.observable.every >= FIRST)
            fitted = fit_curve(time, curve, ringing, [start_damping, guess * k, 1.0, 0.0], use)
            if fitted is None:
                continue
            damping, frequency = fitted.value[:2]
            total = np.hypot(damping, frequency)
            slope = np.array([damping, frequency, 0, 0]) / (total * k)
            value, error = fitted.scalar(total / k, slope)
            expected = coefficients.sound_speed if coefficients else np.nan
            at = f"at k = {k:.4g}/a"
            # c^2 is proportional to the kT that this run started with
            error = 0.5 * setting.with_start(self.case, 2 * error, value, correlator.series)
            note = setting.caveat(self.case)
            yield fitted_number(f"sound speed {at}", value, error, expected, "a/tau", note)
            found = fitted.scalar(2 * damping / k**2, np.array([2 / k**2, 0, 0, 0]))
            yield fitted_number(f"sound attenuation {at}", *found, known, "a^2/tau", note)
