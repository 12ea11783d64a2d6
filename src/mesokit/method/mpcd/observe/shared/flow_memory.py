"""Relaxation time of the momentum of a driven flow, and the error bar that a short run leaves."""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from mesokit.case.case import Case
from mesokit.geometry.solids.solids import free_volume
from mesokit.method.mpcd.expected import setting
from mesokit.method.mpcd.numbers import TIMES
from mesokit.method.mpcd.observe.shared.tensor import kept
from mesokit.observe.shared.short_run import ENOUGH, of_relaxations
from mesokit.seam.method import BuildUp
from mesokit.statistics import Blocks

LONGEST = 100.0  # relaxation time that a run may show, in lengths of the run with its warm-up


class FlowMemory(NamedTuple):
    """A run beside the relaxation time of the momentum of its flow.

    time: the relaxation time; times: length of the run in such times, both nan where no force
    gives them. least: least standard error of the mean momentum: that of a thermal momentum, of
    variance M kT, whose correlation falls as an exponential. runs: how many are pooled, each of
    that length. longest: the relaxation time of a momentum two such errors larger.
    """

    time: float
    times: float
    least: float
    runs: int = 1
    longest: float = np.nan

    @property
    def note(self) -> str:
        """Caveat of a run that is short against the relaxation time."""
        if not self.times < ENOUGH:
            return ""
        return of_relaxations(self.times, self.runs)


def flow_memory(case: Case, axis: int, momentum: float, blocks: Blocks, every: int) -> FlowMemory:
    """That of a run of a mean momentum along an axis, with a sample every so many steps.

    A force drives the flow to the momentum M g t that it gives in the relaxation time t: exact in
    slow flow, for the response to a force is the integral of the momentum's correlation (Kubo
    1957). A flow from rest has not all of it yet: t is that of an exponential approach whose mean
    over the samples is the momentum seen.
    """
    mass = setting.mass_density(case) * free_volume(case)
    acceleration = float(setting.uniform_acceleration(case)[axis])
    given = momentum / (mass * acceleration) if acceleration else -1.0
    length = blocks.count / blocks.series * every * case.fluid.timestep
    if not (case.walls and given > 0 and length > 0):
        return FlowMemory(np.nan, np.nan, 0.0)
    had = np.inf if case.fluid.start.run is not None else case.run.warmup * case.fluid.timestep
    time = _relaxation(given, had, length)
    times = length / time
    least = float((mass * case.fluid.kT * kept(times) / blocks.series) ** 0.5)
    more = given + 2 * least / abs(mass * acceleration)
    return FlowMemory(time, times, least, blocks.series, _relaxation(more, had, length))


def _relaxation(given: float, had: float, length: float) -> float:
    """Time t whose t (1 - mean of exp(-s/t) over s from had to had + length) is the time given, at
    most `LONGEST` of the run.

    >>> [round(_relaxation(t, 100.0, 50.0), 1) for t in (1.0, 79.0, 124.9)]
    [1.0, 126.1, 15000.0]
    """
    longest = LONGEST * (had + length)

    def missing(time: float) -> float:
        left = math.exp(-had / time) * -math.expm1(-length / time) * time / length
        return time * (1 - left) - given

    if math.isinf(had) or missing(given) >= 0:
        return given
    return longest if missing(longest) < 0 else float(brentq(missing, given, longest))


def build_up_of(memory: FlowMemory, case: Case) -> BuildUp | None:
    """Build-up of the flow from rest, by the largest momentum that it may well have; None where
    no force gives it."""
    if np.isnan(memory.time) or case.fluid.start.run is not None or not case.fluid.force.steady:
        return None
    steps = memory.longest / case.fluid.timestep
    return BuildUp(steps, math.ceil(TIMES * steps), case.run.warmup)
