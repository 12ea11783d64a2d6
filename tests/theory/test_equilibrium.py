"""Maxwell velocities and the gamma law of the energy of a cell."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from scipy.integrate import quad

from mesokit.theory import (
    cell_energy_cdf,
    cell_energy_pdf,
    cell_energy_variance,
    maxwell_component_cdf,
    maxwell_component_pdf,
    maxwell_speed_cdf,
    maxwell_speed_pdf,
)

scale = st.floats(0.1, 10)


@given(v=st.floats(-5, 5), kT=scale, mass=scale)
def test_velocity_component_is_normal(v, kT, mass):
    normal = stats.norm(scale=np.sqrt(kT / mass))
    assert maxwell_component_pdf(v, kT, mass) == pytest.approx(normal.pdf(v), rel=1e-9)
    assert maxwell_component_cdf(v, kT, mass) == pytest.approx(normal.cdf(v), rel=1e-9)


@given(v=st.floats(-1, 5), kT=scale, mass=scale, d=st.sampled_from([1, 2, 3]))
def test_speed_is_chi(v, kT, mass, d):
    chi = stats.chi(d, scale=np.sqrt(kT / mass))
    if v != 0:  # the density jumps there in 1D
        assert maxwell_speed_pdf(v, d, kT, mass) == pytest.approx(chi.pdf(v), rel=1e-9)
    assert maxwell_speed_cdf(v, d, kT, mass) == pytest.approx(chi.cdf(v), rel=1e-9, abs=1e-300)


@given(e=st.floats(-1, 40), n=st.integers(2, 20), d=st.sampled_from([2, 3]), kT=scale)
def test_cell_energy_is_gamma(e, n, d, kT):
    gamma = stats.gamma(d * (n - 1) / 2, scale=kT)
    if e != 0:
        expected = pytest.approx(gamma.pdf(e), rel=1e-8, abs=1e-300)
        assert cell_energy_pdf(e, n, d, kT) == expected
    assert cell_energy_cdf(e, n, d, kT) == pytest.approx(gamma.cdf(e), rel=1e-8, abs=1e-300)
    assert cell_energy_variance(n, d, kT) == pytest.approx(gamma.var())


def test_cell_energy_moments():
    f = 3 * 9
    mean = quad(lambda e: e * float(cell_energy_pdf(e, 10, 3, 2.0)), 0, 300)[0]
    square = quad(lambda e: e * e * float(cell_energy_pdf(e, 10, 3, 2.0)), 0, 300)[0]
    assert mean == pytest.approx(f * 2.0 / 2)
    assert square - mean**2 == pytest.approx(cell_energy_variance(10, 3, 2.0))


def test_cell_energy_of_sampled_velocities():
    v = np.random.default_rng(2).normal(size=(20_000, 5, 3))
    v -= v.mean(axis=1, keepdims=True)
    energy = (v**2).sum(axis=(1, 2)) / 2
    assert stats.kstest(energy, lambda e: cell_energy_cdf(e, 5, 3)).pvalue > 1e-3


def test_refuses():
    with pytest.raises(ValueError, match="kT = 0"):
        maxwell_component_pdf(0.0, kT=0)
    with pytest.raises(ValueError, match="dimension = 4"):
        maxwell_speed_cdf(1.0, 4)
    with pytest.raises(ValueError, match="particles = 1"):
        cell_energy_cdf(1.0, 1, 3)
