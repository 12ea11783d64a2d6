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

LARGEST = 100.0  # relaxation time that is searched for, over the time of the run and its warm-up


class FlowMemory(NamedTuple):
    """Relaxation time of the momentum of a flow, and the length of a run beside it.

    time: the relaxation time; relaxations: length of the run over it, both nan where no force
    gives them. least: least standard error of the mean momentum, which is that of a thermal
    momentum of variance M kT with an exponential correlation. runs: number of pooled runs, each of
    that length. upper: relaxation time of a momentum that is two such errors larger.
    """

    time: float
    relaxations: float
    least: float
    runs: int = 1
    upper: float = np.nan

    @property
    def note(self) -> str:
        """Caveat of a run that is short against the relaxation time."""
        if not self.relaxations < ENOUGH:
            return ""
        return of_relaxations(self.relaxations, self.runs)


def flow_memory(case: Case, axis: int, momentum: float, blocks: Blocks, every: int) -> FlowMemory:
    """Memory of the flow along an axis from the mean momentum of a run, sampled at intervals.

    The momentum of a steady flow is M g t with the mass M, the acceleration g and the relaxation
    time t: exact in slow flow, where the response to a force is the integral of the momentum's
    correlation (Kubo 1957). A flow from rest approaches it as an exponential: then t is the time
    for which the mean of that approach over the samples is the measured momentum.
    """
    mass = setting.mass_density(case) * free_volume(case)
    acceleration = float(setting.uniform_acceleration(case)[axis])
    # the time M g t / (M g) of a steady flow; without walls or against the force there is none
    apparent = momentum / (mass * acceleration) if acceleration else -1.0
    length = blocks.count / blocks.series * every * case.fluid.timestep
    if not (case.walls and apparent > 0 and length > 0):
        return FlowMemory(np.nan, np.nan, 0.0)
    flowed = case.run.warmup * case.fluid.timestep  # before the first sample
    if case.fluid.start.run is not None:
        flowed = np.inf
    time = _relaxation(apparent, flowed, length)
    relaxations = length / time
    least = float((mass * case.fluid.kT * kept(relaxations) / blocks.series) ** 0.5)
    more = apparent + 2 * least / abs(mass * acceleration)
    return FlowMemory(time, relaxations, least, blocks.series, _relaxation(more, flowed, length))


def _relaxation(apparent: float, flowed: float, length: float) -> float:
    """Relaxation time t of a flow that began a time `flowed` before samples of a length.

    It solves apparent = t (1 - t/length (exp(-flowed/t) - exp(-(flowed + length)/t))) and is at
    most `LARGEST` times both together.

    >>> [round(_relaxation(t, 100.0, 50.0), 1) for t in (1.0, 79.0, 124.9)]
    [1.0, 126.1, 15000.0]
    """
    largest = LARGEST * (flowed + length)

    def missing(time: float) -> float:
        left = math.exp(-flowed / time) * -math.expm1(-length / time) * time / length
        return time * (1 - left) - apparent

    if math.isinf(flowed) or missing(apparent) >= 0:
        return apparent
    return largest if missing(largest) < 0 else float(brentq(missing, apparent, largest))


def build_up_of(memory: FlowMemory, case: Case) -> BuildUp | None:
    """Build-up of the flow from rest, by the upper relaxation time; None where
    no force gives it."""
    if np.isnan(memory.time) or case.fluid.start.run is not None or not case.fluid.force.steady:
        return None
    steps = memory.upper / case.fluid.timestep
    return BuildUp(steps, math.ceil(TIMES * steps), case.run.warmup)
