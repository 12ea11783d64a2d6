"""Suspensions and slits: surfaces that slip in a strain, point forces between plates, settling."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from mesokit.theory import (
    barometric_cdf,
    buoyant_scale,
    compressibility,
    dilute_settling,
    hindered_settling,
    settling_of_few,
    slit_mobility,
    suspension_viscosity,
)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("slip", [0.0, 0.2, 50.0])
def test_flow_about_a_body_in_a_strain_obeys_its_surface(d, slip):
    """Its strength, of x(xEx)/r^(d+2), is what the viscosity gains by phi; R = 1."""
    strength = -2 * (suspension_viscosity(0.5, d, slip) - 1)
    gradient = (strength + 1) / d  # then nothing flows through the surface
    strain = np.array([[0.3, 0.5, 0.1], [0.5, -0.7, 0.2], [0.1, 0.2, 0.4]])[:d, :d]
    strain -= np.eye(d) * np.trace(strain) / d

    def flow(x):
        r = np.linalg.norm(x, axis=1)[:, None]
        stretched = x @ strain
        along = (stretched * x).sum(1)[:, None] * x
        more = 2 * stretched / r ** (d + 2) - (d + 2) * along / r ** (d + 4)
        return stretched + strength * along / r ** (d + 2) + gradient * more

    n = np.array([[0.6, 0.8, 0.0], [0.8, -0.6, 0.0]])[:, :d]
    h = 1e-5
    slopes = np.stack([(flow(n + s) - flow(n - s)) / (2 * h) for s in h * np.eye(d)], -1)
    stress = np.einsum("nij,nj->ni", slopes + np.swapaxes(slopes, 1, 2), n)
    across = stress - (stress * n).sum(1)[:, None] * n
    assert flow(n) == pytest.approx(slip * across, abs=1e-7)


def test_published_viscosities():
    assert suspension_viscosity(0.04) == pytest.approx(1.1)
    assert suspension_viscosity(0.04, 2) == pytest.approx(1.08)
    assert suspension_viscosity(0.04, slip=1e9) == pytest.approx(1.04)  # of bubbles
    assert suspension_viscosity(0.1, order=2) == pytest.approx(1.312)


def along_and_across(k):
    """Velocity at the middle of a slit |y| < 1 by a force there that varies as cos kx, eta = 1:
    along the wave, its Laplacian without the point itself, and across."""
    s, c = math.sinh(k), math.cosh(k)
    # w = a sinh ky + y (b cosh ky + e sinh ky), e by the force; w = w' = 0 at the plate
    e = -0.25
    a, b = np.linalg.solve([[s, c], [k * c, c + k * s]], [-e * s, -e * (s + k * c)])
    return a + b / k, 2 * k * (b - 0.25), math.tanh(k) / (2 * k)


def test_slit_is_faxen_s():
    """The images of a point force, (1 + R^2/6 Laplacian) twice: the terms R/h and (R/h)^3."""

    def summed(function):
        return 6 * math.pi * quad(lambda k: k / (2 * math.pi) * function(k), 1e-6, 18)[0]

    first = summed(lambda k: 0.5 * (along_and_across(k)[0] + along_and_across(k)[2]) - 3 / (8 * k))
    third = summed(lambda k: along_and_across(k)[1] / 6)
    x = np.linspace(0.02, 0.3, 12)
    found = np.polynomial.Polynomial.fit(x, [slit_mobility(r, 1.0) for r in x], 5).convert().coef
    assert found[:3] == pytest.approx([1, first, 0], abs=2e-4)
    assert found[3] == pytest.approx(third, abs=1e-3)
    assert found[4:] == pytest.approx([0.21, -0.169], abs=1e-6)


def test_periodic_slit_is_the_sum_over_waves():
    """Less the integral over them: what the force on other spheres adds."""
    side, blur = 8.0, 0.3

    def waves(k, share):
        """Of an angle whose squared cosine is the share; the blur changes images by nothing."""
        along, _, across = along_and_across(k)
        return (share * along + (1 - share) * across) * math.exp(-((blur * k) ** 2))

    n = range(-12, 13)
    lattice = sum(
        waves(2 * math.pi / side * math.hypot(i, j), i**2 / (i**2 + j**2))
        for i in n
        for j in n
        if i or j
    )
    infinite = quad(lambda k: k / (2 * math.pi) * waves(k, 0.5), 1e-6, 16)[0]
    resting = {"plates": 1 / 2, "uniform": 1 / 4, "no flux": 1 / 8}  # of the mean over the plane
    radius = 0.2
    for taken_by, flow in resting.items():
        more = 6 * math.pi * radius * ((lattice + flow) / side**2 - infinite)
        change = slit_mobility(radius, 1.0, side**2, taken_by) - slit_mobility(radius, 1.0)
        assert change == pytest.approx(more, rel=2e-3), taken_by


def test_numbers_of_the_slit():
    assert slit_mobility(2.0, 10.0) == pytest.approx(0.803, abs=5e-4)
    assert slit_mobility(3.5, 10.0) == pytest.approx(0.669, abs=5e-4)
    change = slit_mobility(1.0, 10.0, 100.0, "uniform") - slit_mobility(1.0, 10.0)
    assert change == pytest.approx(-0.118, abs=5e-4)


def test_settling():
    assert dilute_settling(0.01) == pytest.approx(0.9345)
    assert hindered_settling(0.3, 4.65) == pytest.approx(0.7**4.65)
    assert settling_of_few(1e-9, 1) == pytest.approx(1.7601e-3, rel=1e-6)  # of Hasimoto
    x, h = 0.2, 1e-4
    pressure = [y * compressibility(y, 3) for y in (x - h, x + h)]
    structure = 2 * h / (pressure[1] - pressure[0])
    expected = 1.7601 * structure * (x / 27) ** (1 / 3) / 1.8
    assert settling_of_few(x, 27, 1.8) == pytest.approx(expected, rel=5e-3)


def test_heights_of_a_buoyant_body():
    """The share above z falls as exp(-work/kT)."""
    scale = buoyant_scale(30.0, 20.0, 0.05, 1.3)
    above = 1 - barometric_cdf(4.0, scale, 1e9)
    assert above == pytest.approx(math.exp(-10 * 0.05 * 4.0 / 1.3))
    assert buoyant_scale(10.0, 20.0, 0.05) < 0


def test_suspensions_refuse():
    with pytest.raises(ValueError, match=r"fraction = 1\.5: expected a volume fraction below 1"):
        suspension_viscosity(1.5)
    with pytest.raises(ValueError, match="order = 2"):
        suspension_viscosity(0.1, 2, order=2)
    with pytest.raises(ValueError, match="radius = 3"):
        slit_mobility(3, 2)
    with pytest.raises(ValueError, match="taken_by = 'x'"):
        slit_mobility(1, 2, taken_by="x")
    with pytest.raises(ValueError, match=r"at most 0\.5"):
        settling_of_few(0.6, 10)
    with pytest.raises(ValueError, match="at most 1"):
        hindered_settling(1.1)
    with pytest.raises(ValueError, match="weight"):
        buoyant_scale(10.0, 10.0, 0.05)
