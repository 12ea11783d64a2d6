"""Moduli of the stress that particles carry in their flights."""

import cmath

from mesokit.theory._check import positive


def flight_moduli(
    frequency: float, timestep: float, viscosity: float, pressure: float
) -> tuple[float, float]:
    """Storage and loss modulus of the kinetic stress of an MPCD fluid in oscillating shear.

    A flight in shear adds n kT dt times the rate to the kinetic stress, and each collision keeps
    the part f of it. The stress of a step is the mean of that before and after its collision. At
    zero frequency this is the kinetic viscosity n kT dt (1/(1 - f) - 1/2), which gives f.

    Parameters:
        frequency: angular frequency w of the strain.
        timestep: dt of the fluid.
        viscosity: its dynamic kinetic viscosity at rest, see `transport`.
        pressure: n kT.

    Raises ValueError unless all are above 0.

    Returns both in the unit of n kT.

    Source: derived here, as the sum over steps of the geometric memory by which `transport` has its
    kinetic viscosity: G' + i G'' = i w n kT dt (1 + f)/2 / (1 - f exp(-i w dt)).

    >>> storage, loss = flight_moduli(0.16, 1.2, 6.0 * 1.2 * 0.7, 6.0)
    >>> round(storage, 4), round(loss, 3)
    (0.0305, 0.802)
    """
    positive(frequency=frequency, timestep=timestep, viscosity=viscosity, pressure=pressure)
    kept = 1 - 1 / (viscosity / (pressure * timestep) + 0.5)
    memory = 1 - kept * cmath.exp(-1j * frequency * timestep)
    modulus = 1j * frequency * pressure * timestep * (1 + kept) / 2 / memory
    return modulus.real, modulus.imag
