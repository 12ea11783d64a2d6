"""A spring along a surface that slips: friction with a memory (Cundall and Strack 1979).

The same for sliding and for rolling: what differs is the velocity that stretches it.
"""

import math
from typing import NamedTuple

from mesokit.scalar.jit import scalar
from mesokit.scalar.vector import added_scaled, dot, scaled


class Slider(NamedTuple):
    """Stiffness (0: a dashpot alone) and damping of a spring, and the largest force."""

    stiffness: float
    damping: float
    limit: float


class Springs(NamedTuple):
    """The springs of a contact: how far it slid and rolled, held back by friction."""

    sliding: tuple[float, float, float]
    rolling: tuple[float, float, float]


@scalar
def stretched(slider, spring, velocity, normal, step):
    """The force, and the spring after a step: turned with the plane, stretched, and cut back to
    where it holds the largest force."""
    spring = added_scaled(spring, step, velocity)
    spring = added_scaled(spring, -dot(spring, normal), normal)
    force = added_scaled(scaled(-slider.stiffness, spring), -slider.damping, velocity)
    square = dot(force, force)
    if square > slider.limit * slider.limit:
        force = scaled(slider.limit / math.sqrt(square), force)
        if slider.stiffness > 0.0:
            held = added_scaled(force, slider.damping, velocity)
            spring = scaled(-1.0 / slider.stiffness, held)
    return force, spring
