"""Rules by which walls reflect particles."""

from typing import Any, Literal

from pydantic import field_validator

from mesokit.case.component import component, param
from mesokit.case.describe.hints import Either


@component
class SurfaceContact:
    """Restitution, friction, temperature and motion of a surface that spheres touch.

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
    speed: float = param(
        0.0,
        doc="a plate moves so fast along its normal, into the box",
        unit="length/time",
        ge=-1e6,
        le=1e6,
    )
    travel: float | None = param(
        None, doc="how far it moves at that speed (on and on unless said)", unit="length", gt=0
    )
    force: float | None = param(
        None,
        doc="a plate is pushed into the box by this force, and moves as grains let it",
        unit="mass length/time^2",
        gt=0,
        le=1e12,
    )
    pressure: float | None = param(
        None,
        doc="a plate is pushed into the box by this force per area between the plates across it",
        unit="mass length^(2-d)/time^2",
        gt=0,
        le=1e12,
    )
    mass: float | None = param(
        None, doc="of a plate that is pushed (that of all grains unless said)", unit="mass", gt=0
    )

    @property
    def drives(self) -> bool:
        """Whether a plate moves along its normal: at a speed, or pushed."""
        return bool(self.speed or self.force or self.pressure)


FASTEST = 1e6  # a surface's speed and rate of rotation: beyond it is a slip of the pen


@component
class Surface:
    """A wall surface, at rest, moving along itself, or turning."""

    rule: Literal["no-slip", "slip", "diffuse"] = param(
        "no-slip",
        doc="'no-slip' bounces particles back, 'slip' reflects them like a mirror, 'diffuse' sends "
        "them out with the wall's temperature",
    )
    velocity: Either[None, float] = param(
        None, doc="one number for each axis, along the wall (at rest unless said)", unit="a/time"
    )
    rotation: Either[float | None, float] = param(
        None,
        doc="rate of rotation, in radians: a number, about z in 2D or about the shape's own axis, "
        "or a vector in 3D",
        unit="1/time",
    )
    contact: SurfaceContact | None = param(
        None, doc="what it does to spheres (as between two of them unless said)"
    )

    @field_validator("velocity")
    @classmethod
    def _two_or_three(cls, velocity: tuple[float, ...] | None) -> tuple[float, ...] | None:
        if velocity is not None and len(velocity) not in (2, 3):
            raise ValueError("expected one number for each axis")
        return velocity

    @field_validator("velocity", "rotation")
    @classmethod
    def _sane(cls, value: Any) -> Any:
        numbers = value if isinstance(value, tuple) else (value or 0.0,)
        if any(abs(x) > FASTEST for x in numbers):
            raise ValueError(f"expected numbers of at most {FASTEST:g}")
        return value

    @property
    def moves(self) -> bool:
        """Whether it drags the fluid along."""
        turning = self.rotation if isinstance(self.rotation, tuple) else (self.rotation or 0.0,)
        return any(self.velocity or ()) or any(turning)
