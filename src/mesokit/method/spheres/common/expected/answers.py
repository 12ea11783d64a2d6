"""Theory of both methods of spheres, by observable."""

from collections.abc import Callable
from functools import partial
from typing import Any

from mesokit.case.case import Case
from mesokit.method.spheres.common.expected.equilibrium import Equilibrium
from mesokit.method.spheres.common.expected.slices import (
    DensityInSlices,
    FlowInSlices,
    TemperatureInSlices,
)
from mesokit.method.spheres.common.expected.velocities import Cumulant, VelocitiesOfSpheres

ALL = (DensityInSlices, FlowInSlices, TemperatureInSlices, VelocitiesOfSpheres, Cumulant)


def answers(find: Callable[[Case], Equilibrium | None]) -> dict[str, Callable[[Case, Any], Any]]:
    """Theories by the observables that they answer, of a method that finds equilibrium so."""
    return {one.answers: partial(one, find) for one in ALL}
