"""What a wall surface does to spheres that touch it."""

from __future__ import annotations

from mesokit.case.component import component, param


@component
class SurfaceContact:
    """Restitution, friction, temperature and vibration of a surface that spheres touch.

    What is not said is as between two spheres.
    """

    restitution: float | None = param(
        None, doc="normal velocity after over before a collision", ge=0, le=1
    )
    tangential: float | None = param(
        None,
        doc="tangential velocity of the contact after a collision over minus that before: -1 "
        "smooth, 1 perfectly rough",
        ge=-1,
        le=1,
    )
    friction: float | None = param(
        None, doc="coefficient of friction: largest tangential over normal force", ge=0, le=1e6
    )
    temperature: float | None = param(
        None, doc="thermal energy of a wall that sends them out at random", unit="kT", gt=0, le=1e9
    )
    amplitude: float = param(0.0, doc="it vibrates so far along its normal", unit="a", ge=0)
    frequency: float = param(
        0.0, doc="of the vibration, in radians per time", unit="1/time", ge=0, le=1e9
    )
