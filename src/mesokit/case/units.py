"""The real fluid that a case stands for, and what of it the units are made to match."""

import math
from typing import ClassVar, Literal

from mesokit.case.component import component, param, tag
from mesokit.case.similarity import Properties
from mesokit.theory import water_density, water_diffusion, water_sound_speed, water_viscosity
from mesokit.theory.water import COLDEST, HOTTEST

BOLTZMANN = 1.380649e-23  # J/K, exact since 2019

# match: the two properties whose values are those of the real fluid; with the length of a cell
# they fix the units of mass and time
MATCHES = {
    "reynolds": ("density", "dynamic_viscosity"),
    "peclet": ("dynamic_viscosity", "kT"),
    "mach": ("density", "sound_speed"),
    "thermal": ("density", "kT"),
}


@component
class Water:
    """Liquid water at 0.1 MPa; density, viscosity, self-diffusion and sound by its temperature."""

    title: ClassVar[str] = "water"
    substance: Literal["water"] = tag("water")
    temperature: float = param(
        298.15, doc="0 to 100 degrees Celsius, in kelvins", unit="K", ge=COLDEST, le=HOTTEST
    )

    def properties(self) -> Properties:
        """Its properties in SI units (sources: `mesokit.theory.water`)."""
        t = self.temperature
        return Properties(
            water_density(t),
            water_viscosity(t),
            BOLTZMANN * t,
            water_diffusion(t),
            water_sound_speed(t),
        )


@component
class OtherFluid:
    """Any other fluid, by its properties in SI units."""

    title: ClassVar[str] = "a fluid"
    substance: Literal["other"] = tag("other")
    density: float = param(doc="mass density", unit="kg/m^3", ge=1e-3, le=1e5)
    dynamic_viscosity: float = param(doc="dynamic viscosity", unit="Pa s", ge=1e-8, le=1e8)
    temperature: float = param(doc="temperature", unit="K", ge=0.1, le=1e5)
    diffusion: float | None = param(
        None, doc="self-diffusion of its molecules", unit="m^2/s", ge=1e-25, le=1
    )
    sound_speed: float | None = param(None, doc="speed of sound", unit="m/s", ge=0.1, le=1e5)

    def properties(self) -> Properties:
        """Its properties in SI units."""
        return Properties(
            self.density,
            self.dynamic_viscosity,
            BOLTZMANN * self.temperature,
            math.nan if self.diffusion is None else self.diffusion,
            math.nan if self.sound_speed is None else self.sound_speed,
        )


@component
class Units:
    """Units of a case in SI.

    The cell gives the unit of length. Two properties that become those of the real fluid give the
    units of mass and time: "reynolds" mass density and viscosity (flow with inertia), "peclet"
    viscosity and k_B T (Brownian motion in 3D), "mach" mass density and speed of sound, "thermal"
    mass density and k_B T (thermal fluctuations of the flow). No choice matches everything.
    """

    cell: float = param(doc="length of a cell", unit="m", ge=1e-10, le=1e3)
    match: Literal["reynolds", "peclet", "mach", "thermal"] = param(
        doc="the number that becomes that of the real fluid"
    )
    fluid: Water | OtherFluid = param(Water(), doc="the real fluid")
    depth: float | None = param(
        None,
        doc="depth of the slice that a 2D box stands for (one cell unless said)",
        unit="m",
        ge=1e-10,
        le=1e3,
    )
