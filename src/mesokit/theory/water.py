"""Liquid water at 0.1 MPa between 0 and 100 degrees Celsius, in SI units."""

from collections.abc import Sequence

COLDEST, HOTTEST = 273.15, 373.15  # K
_DENSITY = (999.83952, 16.945176, -7.9870401e-3, -46.170461e-6, 105.56302e-9, -280.54253e-12)
_VISCOSITY = ((280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.45903, -40.0))
_SOUND = [
    1402.38744, 5.03836171, -5.81172916e-2, 3.34638117e-4, -1.48259672e-6, 3.16585020e-9,
]  # fmt: skip


def water_density(temperature: float) -> float:
    """Mass density in kg/m^3 at a temperature in K.

    A polynomial of fifth order in the temperature in degrees Celsius over 1 + 0.01687985 of it.
    Raises ValueError outside 273.15 to 373.15 K. Source: G. S. Kell, J. Chem. Eng. Data 20, 97
    (1975); on the temperature scale of today good to some 0.002 %.

    >>> round(water_density(298.15), 2)
    997.04
    """
    celsius = _celsius(temperature)
    return _polynomial(_DENSITY, celsius) / (1 + 16.879850e-3 * celsius)


def water_viscosity(temperature: float) -> float:
    """Dynamic viscosity in Pa s at a temperature in K.

    A sum of four powers of T/300 K. Raises ValueError outside 273.15 to 373.15 K. Source: J. Patek,
    J. Hruby, J. Klomfar, M. Souckova and A. H. Harvey, J. Phys. Chem. Ref. Data 38, 21 (2009), the
    IAPWS supplementary release SR6-08 for 0.1 MPa, fitted to the IAPWS formulation of 2008; good
    to 1 %.

    >>> round(1e3 * water_viscosity(298.15), 4)
    0.89
    """
    _celsius(temperature)
    return 1e-6 * sum(a * (temperature / 300) ** b for a, b in _VISCOSITY)


def water_diffusion(temperature: float) -> float:
    """Self-diffusion coefficient of the molecules in m^2/s at a temperature in K.

    D = D0 (T/Ts - 1)^2.063. Raises ValueError outside 273.15 to 373.15 K. Source: M. Holz,
    S. R. Heil and A. Sacco, Phys. Chem. Chem. Phys. 2, 4740 (2000), good to 1 %.

    >>> round(1e9 * water_diffusion(298.15), 2)
    2.3
    """
    _celsius(temperature)
    return 1.635e-8 * (temperature / 215.05 - 1) ** 2.063


def water_sound_speed(temperature: float) -> float:
    """Speed of sound in m/s at a temperature in K.

    A polynomial of fifth order in degrees Celsius. Raises ValueError outside 273.15 to 373.15 K.
    Source: N. Bilaniuk and G. S. K. Wong, J. Acoust. Soc. Am. 93, 1609 (1993), 148 points, with
    the erratum 99, 3257 (1996); good to some 0.05 m/s.

    >>> round(water_sound_speed(298.15), 1)
    1496.7
    """
    return _polynomial(_SOUND, _celsius(temperature))


def _celsius(temperature: float) -> float:
    """The temperature in degrees Celsius, if the formulas hold there."""
    if not COLDEST <= temperature <= HOTTEST:
        raise ValueError(
            f"temperature = {temperature!r}: expected kelvins from {COLDEST} to {HOTTEST}"
        )
    return temperature - COLDEST


def _polynomial(coefficients: Sequence[float], x: float) -> float:
    return sum(c * x**k for k, c in enumerate(coefficients))
