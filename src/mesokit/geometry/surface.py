"""What a wall does to the particles that hit it."""

from __future__ import annotations

from typing import Literal

from pydantic import field_validator

from mesokit.component import component, param


@component
class Surface:
    """A wall surface, at rest or moving along itself."""

    rule: Literal["no-slip", "slip"] = param(
        "no-slip", doc="'no-slip' bounces particles back, 'slip' reflects them like a mirror"
    )
    velocity: tuple[float, ...] | None = param(
        None, doc="one number for each axis, along the wall (at rest unless said)", unit="a/time"
    )

    @field_validator("velocity")
    @classmethod
    def _two_or_three(cls, velocity: tuple[float, ...] | None) -> tuple[float, ...] | None:
        if velocity is not None and len(velocity) not in (2, 3):
            raise ValueError("expected one number for each axis")
        return velocity
