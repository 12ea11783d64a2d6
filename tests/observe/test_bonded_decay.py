"""Relaxation time and viscosity from velocity modes of a fluid of molecules."""

import numpy as np
import pytest

from mesokit import theory
from mesokit.method.mpcd.observe.transverse_modes import BondedLaw, fit_bonded
from mesokit.seam.estimate import Estimate

LAW = BondedLaw(
    2 * np.pi / 16, 0.5, theory.GaussianMolecule(theory.linear_modes(2), 30.0, 9.0, 0.03)
)
TRUE = np.log([0.8, 27.0])
TIME = np.linspace(0.3, 30.0, 60)


def seen(rng, noise=0.02, blocks=32):
    """A curve with noise that is common to neighbouring lags, and its blocks."""
    kernel = np.exp(-((np.arange(-9, 10) / 4.0) ** 2))
    each = rng.normal(size=(blocks, len(TIME) + 18))
    each = np.apply_along_axis(np.convolve, 1, each, kernel / kernel.sum(), "valid")
    each *= noise * blocks**0.5
    curve = LAW(TIME, *np.exp(TRUE)) + each.mean(axis=0)
    return Estimate(curve, (each - each.mean(axis=0)) / blocks, np.ones(blocks))


def test_it_finds_what_made_the_curve_within_its_errors():
    rng = np.random.default_rng(2)
    found = []
    for _ in range(6):
        fitted = fit_bonded(TIME, seen(rng), LAW, (0.87, 25.0), TIME > 0)
        found.append((fitted.value - TRUE) / fitted.error)
    assert np.abs(found).max() < 4
    assert 0.3 < np.sqrt(np.mean(np.square(found))) < 1.8


def test_without_noise_it_is_exact():
    curve = Estimate(LAW(TIME, *np.exp(TRUE)), np.zeros((8, len(TIME))), np.ones(8))
    fitted = fit_bonded(TIME, curve, LAW, (1.2, 15.0), TIME > 0)
    assert np.exp(fitted.value) == pytest.approx([0.8, 27.0], rel=1e-5)
