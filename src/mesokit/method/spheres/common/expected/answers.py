"""What the methods of spheres answer to observables that they share."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from mesokit.method.spheres.common.expected.equilibrium import Equilibrium
from mesokit.method.spheres.common.expected.slices import (
    DensityInSlices,
    FlowInSlices,
    TemperatureInSlices,
)
from mesokit.method.spheres.common.expected.velocities import Cumulant, VelocitiesOfSpheres

if TYPE_CHECKING:
    from mesokit.case.case import Case

ALL = (DensityInSlices, FlowInSlices, TemperatureInSlices, VelocitiesOfSpheres, Cumulant)


def answers(find: Callable[[Case], Equilibrium | None]) -> dict[str, Callable[[Case, Any], Any]]:
    """Theories by the observables that they answer, of a method that finds equilibrium so."""
    return {one.answers: partial(one, find) for one in ALL}
