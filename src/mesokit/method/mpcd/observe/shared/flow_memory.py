"""How long the momentum of a driven flow is remembered, and what that leaves of its error bar."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.observe.shared.molecule_tensor import kept
from mesokit.observe.velocity_profile import ENOUGH
from mesokit.statistics import Blocks

if TYPE_CHECKING:
    from mesokit.case.case import Case


class FlowMemory(NamedTuple):
    """A run beside the relaxation time of the momentum of its flow.

    times: length of the run in relaxation times, nan where no force tells it. least: least standard
    error of the mean momentum, 0 in a long run; in a short one that of a thermal momentum, of
    variance M kT, whose correlation falls as an exponential.
    """

    times: float
    least: float

    @property
    def note(self) -> str:
        """Where blocking cannot see how slowly the flow changes: a caveat."""
        if not self.times < ENOUGH:
            return ""
        return f"error bar is a lower bound: the run has {self.times:.2g} relaxation times"


def flow_memory(case: Case, axis: int, momentum: float, blocks: Blocks, every: int) -> FlowMemory:
    """That of a run of a mean momentum along an axis, with a sample every so many steps.

    A force drives the flow to the momentum that it gives in the relaxation time: exact in slow
    flow, for the response to a force is the integral of the momentum's correlation (Kubo 1957).
    """
    mass = setting.mass_density(case) * free_volume(case)
    acceleration = float(setting.uniform_acceleration(case)[axis])
    time = momentum / (mass * acceleration) if acceleration else -1.0
    if not (case.walls and time > 0):
        return FlowMemory(np.nan, 0.0)
    times = blocks.count / blocks.series * every * case.fluid.timestep / time
    least = 0.0
    if times < ENOUGH:
        least = float((mass * case.fluid.kT * kept(times) / blocks.series) ** 0.5)
    return FlowMemory(times, least)
