"""Water: the formulas give the values that handbooks list, and refuse what they do not cover."""

import pytest

from mesokit.theory import water_density, water_diffusion, water_sound_speed, water_viscosity

LAWS = [water_density, water_diffusion, water_sound_speed, water_viscosity]


@pytest.mark.parametrize(
    ("celsius", "density"),  # CRC Handbook of Chemistry and Physics, at 0.1 MPa
    [(0, 999.84), (4, 999.97), (20, 998.21), (25, 997.05), (50, 988.03), (80, 971.79),
     (100, 958.37)],
)  # fmt: skip
def test_density(celsius, density):
    assert water_density(273.15 + celsius) == pytest.approx(density, abs=0.025)


@pytest.mark.parametrize(
    ("celsius", "viscosity"),  # CRC Handbook; 20 degrees: ISO/TR 3666
    [(0, 1.792), (10, 1.306), (20, 1.0016), (25, 0.890), (40, 0.653), (60, 0.466), (80, 0.354),
     (100, 0.282)],
)  # fmt: skip
def test_viscosity(celsius, viscosity):
    assert 1e3 * water_viscosity(273.15 + celsius) == pytest.approx(viscosity, rel=2e-3)


@pytest.mark.parametrize(
    ("celsius", "diffusion"),  # R. Mills, J. Phys. Chem. 77, 685 (1973)
    [(1, 1.149), (5, 1.313), (15, 1.777), (25, 2.299), (45, 3.575)],
)
def test_diffusion(celsius, diffusion):
    assert 1e9 * water_diffusion(273.15 + celsius) == pytest.approx(diffusion, rel=0.012)


@pytest.mark.parametrize(
    ("celsius", "speed"),  # V. A. Del Grosso and C. W. Mader, J. Acoust. Soc. Am. 52, 1442 (1972)
    [(0, 1402.39), (10, 1447.27), (20, 1482.34), (25, 1496.69), (50, 1542.55), (74, 1555.14)],
)
def test_sound_speed(celsius, speed):
    assert water_sound_speed(273.15 + celsius) == pytest.approx(speed, abs=0.05)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("temperature", [25, 273.1, 373.2, float("nan")])
def test_refuses_what_is_not_liquid(law, temperature):
    with pytest.raises(ValueError, match=r"expected kelvins from 273\.15 to 373\.15"):
        law(temperature)
