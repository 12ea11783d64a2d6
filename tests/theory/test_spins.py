"""Correlations of spins, against transfer matrices and duality."""

import math

import numpy as np
import pytest

from mesokit.theory import spin_correlation_length


def gap(kT: float, width: int) -> float:
    """Logarithm of the ratio of the two largest eigenvalues of the matrix between two rings."""
    spins = 1 - 2 * ((np.arange(2**width)[:, None] >> np.arange(width)) & 1)
    along = 0.5 * (spins * np.roll(spins, 1, axis=1)).sum(axis=1)
    matrix = np.exp((spins @ spins.T + along[:, None] + along[None, :]) / kT)
    values = np.linalg.eigvalsh(matrix)
    return float(np.log(values[-1] / values[-2]))


def test_correlations_of_a_plane_are_those_of_wide_strips():
    assert 1 / gap(4.0, 9) == pytest.approx(spin_correlation_length(1.0, 4.0, 2), rel=1e-3)


def test_correlations_of_a_chain_are_those_of_its_transfer_matrix():
    known = 1 / math.log(1 / math.tanh(1 / 0.7))
    assert spin_correlation_length(1.0, 0.7, 1) == pytest.approx(known)


@pytest.mark.parametrize("kT", [1.0, 1.9, 2.2])
def test_order_is_correlated_half_as_far_as_its_dual_disorder(kT):
    """Kramers and Wannier: exp(-2J/kT) is tanh(J/kT) at the dual temperature."""
    dual = 1 / math.atanh(math.exp(-2 / kT))
    known = 0.5 * spin_correlation_length(1.0, dual, 2)
    assert spin_correlation_length(1.0, kT, 2) == pytest.approx(known)


def test_nothing_ends_correlations_at_the_critical_point():
    assert spin_correlation_length(2.0, 4 / math.log(1 + 2**0.5), 2) == math.inf


@pytest.mark.parametrize("dimension", [0, 3])
def test_other_dimensions_are_refused(dimension):
    with pytest.raises(ValueError, match="dimension"):
        spin_correlation_length(1.0, 1.0, dimension)
